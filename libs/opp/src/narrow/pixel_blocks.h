// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud/depth_image.h"

#include <Eigen/Core>

#include <vector>

namespace opp {

/// Edge of the squares whose means are samples, as those of patches are, in pixels: over less,
/// errors are correlated.
constexpr int kPatchEdge = 4;

/// Mean of some pixels in a square of the image.
struct PixelBlock {
  int row, col;                                     ///< in blocks
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< about the viewpoint [m]
  double count = 0.0;
};

/// Blocks of `edge` × `edge` pixels that hold some of `pixels`, which ascend, row by row. O(n) but
/// for gaps within rows.
std::vector<PixelBlock> pixelBlocks(const DepthImage& image, const std::vector<int>& pixels,
                                    int edge);

}  // namespace opp
