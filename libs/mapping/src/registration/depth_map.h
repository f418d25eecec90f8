// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"

#include <Eigen/Core>

#include <limits>
#include <vector>

namespace opp::mapping {

/// Range of the nearest surface in each direction from a scan's viewpoint, on the six faces of a
/// cube: tells whether the scan looked through a place. Conservative: a sample covers all
/// directions within its share of the surface, and the nearest one counts.
class DepthMap {
 public:
  explicit DepthMap(const OrientedCloud& cloud);

  /// Range at which the line of sight through `point` first meets a surface [m]; 0 where the scan
  /// saw none. Constant time.
  float range(const Eigen::Vector3f& point) const;

 private:
  void cover(const Eigen::Vector3f& ray, float angular_radius);

  Eigen::Vector3f viewpoint_;
  std::vector<float> ranges_;
};

}  // namespace opp::mapping
