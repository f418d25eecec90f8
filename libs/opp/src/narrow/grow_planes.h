// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/narrow/narrow_params.h"

#include "cloud/depth_image.h"
#include "narrow/known_surface.h"

#include <cstdint>
#include <vector>

namespace opp {

/// Plane of some pixels.
struct PixelPlane {
  Plane plane;              ///< about the viewpoint, turned to it
  std::vector<int> pixels;  ///< ascending
};

/// What makes pixels a plane.
struct RegionRule {
  NarrowParams params;
  double max_incidence = 0.0;  ///< [rad]
  double max_turn = 0.0;       ///< [rad] of a surface across its extent that is not curved
  double test_sigmas = 0.0;
};

/// Planes of the open pixels (one flag each). They grow from where neighbouring cells are flattest,
/// as far as cells lie on them within their noise and what is not yet known of the plane; then they
/// are fitted to all pixels on them, open or not, as far as their edges with other surfaces, known
/// and found: the edges are those of the planes, which a pixel's own noise does not move. O(pixels
/// + open cells × planes).
std::vector<PixelPlane> growPlanes(const DepthImage& image, const std::vector<std::uint8_t>& open,
                                   const std::vector<KnownSurface>& surfaces,
                                   const RegionRule& rule);

}  // namespace opp
