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
};

}  // namespace opp::mapping
