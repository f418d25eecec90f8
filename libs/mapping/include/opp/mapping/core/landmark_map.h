// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace opp::mapping {

/// One primitive of one keyframe: index into the keyframe's list of planes (or corners).
struct PrimitiveObservation {
  int keyframe = 0;
  int primitive = 0;
};

/// A plane of the scene, kept across keyframes. Its id is its index in LandmarkMap::planes.
struct PlaneLandmark {
  Plane plane_in_map;
  std::vector<PrimitiveObservation> observations;  ///< in order of keyframes
};

/// A corner of the scene: where three plane landmarks meet at right angles.
struct CornerLandmark {
  std::array<int, 3> planes{};  ///< plane landmark ids, ascending
  Eigen::Vector3d position_in_map = Eigen::Vector3d::Zero();
  std::vector<PrimitiveObservation> observations;  ///< in order of keyframes
};

/// All landmarks of a map; ids are indices and never change during a run.
struct LandmarkMap {
  std::vector<PlaneLandmark> planes;
  std::vector<CornerLandmark> corners;
};

}  // namespace opp::mapping
