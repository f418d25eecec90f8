// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// Pose of the body at a moment.
struct StampedPose {
  double timestamp = 0.0;  ///< Unix time [s]
  Eigen::Isometry3d map_from_body = Eigen::Isometry3d::Identity();
};

/// Poses in ascending order of time.
using Trajectory = std::vector<StampedPose>;

}  // namespace opp::mapping
