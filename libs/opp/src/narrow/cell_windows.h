// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud/depth_image.h"
#include "narrow/inverse_depth_fit.h"
#include "narrow/inverse_depth_noise.h"
#include "narrow/pixel_cells.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace opp {

/// Variance of a cell's inverse depth.
double cellVariance(const PixelCell& cell, const RayFrame::Ray& ray, const InverseDepthNoise& noise,
                    const DepthImage& image);

/// Plane through a cell and the eight around it.
struct CellWindow {
  bool is_flat = false;  ///< else there is no plane, and what follows is undefined
  RayFrame frame;
  Eigen::Vector3d coefficients;
  Eigen::Matrix3d covariance;
  double misfit = 0.0;  ///< per degree of freedom, and more where cells are missing

  /// Whether the window shows a plane, as far as both are known.
  bool isOn(const RayFrame& plane_frame, const Eigen::Vector3d& plane_coefficients,
            const Eigen::Matrix3d& plane_covariance) const;
};

/// Of each cell. O(cells).
std::vector<CellWindow> cellWindows(const DepthImage& image, const PixelCells& cells);

/// The flat ones, the flattest first. O(n log n).
std::vector<int> flattestFirst(const std::vector<CellWindow>& windows);

}  // namespace opp
