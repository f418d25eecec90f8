// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace opp {

/// Points of one scan as a sensor or a file gives them, in one frame (say which in the variable's
/// name).
struct PointCloud {
  std::vector<Eigen::Vector3f> points;  ///< [m]; not finite: no measurement
  std::vector<Eigen::Vector3f>
      normals;  ///< empty, or as long as points; any sign, any length, NaN: unknown
  /// Grid of an organized cloud: points[row * cols + col]; rows = cols = 0: unorganized.
  int rows = 0;
  int cols = 0;
  bool columns_wrap = false;  ///< the last column borders on the first (spinning lidar)
  Eigen::Vector3f viewpoint =
      Eigen::Vector3f::Zero();  ///< the sensor's origin, in the points' frame [m]

  std::size_t size() const { return points.size(); }
  bool organized() const { return rows > 0 && cols > 0; }
  bool hasNormals() const { return !normals.empty(); }
};

/// Surface samples of one scan: the input of all detection and registration. Evenly spaced, but for
/// detail: where planes are small, samples are closer (`extents`).
/// All vectors have the same length. All entries are finite.
struct OrientedCloud {
  std::vector<Eigen::Vector3f> points;   ///< [m], about `spacing` apart
  std::vector<Eigen::Vector3f> normals;  ///< unit length, on the viewpoint's side of the surface
  std::vector<float>
      sigmas;  ///< [m] standard deviation of one raw point's offset along the normal, here
  std::vector<float> weights;  ///< number of raw points this sample stands for, ≥ 1
  std::vector<float> extents;  ///< [m] edge of the square of surface that a sample stands for, at
                               ///< most `spacing`; empty: `spacing` for all
  std::vector<float> patch_extents;  ///< [m] the same of the patches that were averaged to a
                                     ///< sample; empty: of each sample its own
  Eigen::Vector3f viewpoint =
      Eigen::Vector3f::Zero();  ///< the sensor's origin, in the points' frame [m]
  double spacing = 0.0;         ///< d_min of the sampling [m]
  /// Correlation of the errors of neighbouring raw points, as this cloud shows it; < 0: unknown.
  double noise_correlation = -1.0;
  std::size_t narrow_samples = 0;  ///< so many at the end are of planes found pixel by pixel

  std::size_t size() const { return points.size(); }
  double extent(std::size_t i) const {
    return extents.empty() ? spacing : static_cast<double>(extents[i]);
  }
  double patchExtent(std::size_t i) const {
    return patch_extents.empty() ? extent(i) : static_cast<double>(patch_extents[i]);
  }
};

}  // namespace opp
