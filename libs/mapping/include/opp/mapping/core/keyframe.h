// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/core/scan_views.h"

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
  ScanViews views;  ///< of the scans that follow it

  Eigen::Vector3d viewCentre() const { return map_from_body * view_centre_in_body; }
};

/// Times of the scans that saw a plane primitive of a keyframe: its own, and those of its views,
/// ascending [s].
std::vector<double> timesOfPlane(const Keyframe& keyframe, int plane);

/// The same for a corner.
std::vector<double> timesOfCorner(const Keyframe& keyframe, int corner);

}  // namespace opp::mapping
