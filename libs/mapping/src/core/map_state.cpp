// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/map_state.h"

#include "opp/mapping/core/se3.h"

namespace opp::mapping {

Eigen::Isometry3d poseOf(const MapState& map, const LocalizedScan& scan) {
  const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(scan.keyframe)];
  return normalized(keyframe.map_from_body * scan.keyframe_from_body);
}

}  // namespace opp::mapping
