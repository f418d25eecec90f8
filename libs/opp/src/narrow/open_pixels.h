// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/narrow/narrow_params.h"

#include "cloud/depth_image.h"
#include "cloud/grid_patches.h"
#include "narrow/known_surface.h"

#include <cstdint>
#include <vector>

namespace opp {

/// Per pixel of the image: 1 where something was measured that no surface explains, else 0. Means
/// of 2 × 2 pixels tell, too: something before a wall may be within the noise of each pixel. The
/// moments of the grid's blocks tell which of these lie on one surface as a whole.
/// \param grid of the cloud that the image shows. O(blocks × surfaces + pixels of other blocks).
std::vector<std::uint8_t> openPixels(const DepthImage& image, const GridPatches& grid,
                                     const std::vector<KnownSurface>& surfaces,
                                     const NarrowParams& params);

}  // namespace opp
