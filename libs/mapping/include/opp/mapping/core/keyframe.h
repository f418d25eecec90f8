// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// A scan whose pose is optimized and whose primitives are landmarks. Its id is its index in the
/// map.
struct Keyframe {
  Eigen::Isometry3d map_from_body = Eigen::Isometry3d::Identity();
  ScanFeatures features;
  std::vector<int> landmark_of_plane;  ///< plane landmark of each plane primitive
  /// Mean of what it saw, in the body frame [m]: tells nearness of views for cameras and lidars
  /// alike.
  Eigen::Vector3d view_centre_in_body = Eigen::Vector3d::Zero();

  Eigen::Vector3d viewCentre() const { return map_from_body * view_centre_in_body; }
};

}  // namespace opp::mapping
