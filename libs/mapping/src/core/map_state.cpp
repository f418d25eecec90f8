// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/map_state.h"

namespace opp::mapping {

Eigen::Isometry3d poseOf(const MapState& map, const LocalizedScan& scan) {
  const auto poseOfKeyframe = [&](int keyframe) -> const Eigen::Isometry3d& {
    return map.keyframes[static_cast<std::size_t>(keyframe)].map_from_body;
  };
  const Eigen::Isometry3d& map_from_keyframe = poseOfKeyframe(scan.keyframe);
  Eigen::Isometry3d keyframe_from_body = scan.keyframe_from_body;
  if (scan.open && scan.open->next >= 0) {
    const Vector6d moved =
        difference(scan.open->keyframe_from_next,
                   map_from_keyframe.inverse() * poseOfKeyframe(scan.open->next));
    keyframe_from_body = retract(keyframe_from_body, scan.open->gain * moved);
  }
  return normalized(map_from_keyframe * keyframe_from_body);
}

}  // namespace opp::mapping
