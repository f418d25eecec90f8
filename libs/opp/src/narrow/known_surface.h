// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud/point_noise.h"

#include <Eigen/Geometry>

namespace opp {

/// A plane that was found, and where it can be; all about the viewpoint.
struct KnownSurface {
  Eigen::Vector3f normal;
  float height = 0.0F;  ///< n·x of its points [m]
  Eigen::AlignedBox3f reach;

  bool reaches(const Eigen::Vector3f& point) const { return reach.contains(point); }
  double offset(const Eigen::Vector3f& point) const {
    return static_cast<double>(normal.dot(point) - height);
  }
  /// Of the offset of a point on it that is measured at a range [m²].
  double variance(const PointNoise& noise, double squared_range) const {
    return noise.expected(squared_range, static_cast<double>(height));
  }
};

}  // namespace opp
