// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/frontend/motion_model.h"
#include "opp/mapping/frontend/open_passage.h"

#include <optional>
#include <vector>

namespace opp::mapping {

/// A scan that a body was followed to.
struct FollowedScan {
  StampedPose pose;
  std::optional<Eigen::Isometry3d> odom_from_body;  ///< at that time
  Matrix6d information = Matrix6d::Zero();          ///< see MatchResult
  bool is_open = false;             ///< it leaves its pose open, but for what motion knows
  std::optional<std::size_t> scan;  ///< in MapState::scans; none: it is not in the map
};

/// Sees passages begin and end, see OpenPassage, while a body is followed.
class PassageWatch {
 public:
  explicit PassageWatch(const FrontendParams& params) : params_(params), since_keyframe_(params) {}

  /// A scan between keyframes, after the newest of `map`. O(scans that are open), as all below.
  void addScan(const FollowedScan& scan, MapState& map);

  /// The scan of the newest keyframe of `map`. \param tied what its tie to the one before has from
  /// motion, in that one's frame
  void addKeyframe(const FollowedScan& scan, const PosePrior& tied, MapState& map);

  /// The newest keyframe is where it shall be, and `motion` tells how the body moves there.
  void beginAt(const MotionModel& motion);

  /// The map ends: what followed the last passage is all that will.
  void end(MapState& map);

 private:
  friend struct StateAccess;  // checkpoints
  PassedScan passed(const FollowedScan& scan, int keyframe, const MapState& map);
  /// `known` fixes its pose, and so tells of the scans before.
  void endOpenScans(const FollowedScan& known, const PassedScan& passed_scan, MapState& map);
  void closePassage(MapState& map);

  FrontendParams params_;
  MotionModel since_keyframe_;    ///< poses relative to the newest keyframe
  MotionState begins_;            ///< of that, in that one's frame, before the scans that are open
  bool is_known_ = true;          ///< the last keyframe or a scan since then fixes its pose
  std::vector<PassedScan> open_;  ///< scans since the newest keyframe or the last known pose
  std::optional<OpenPassage> passage_;  ///< the last one, until enough scans followed
};

}  // namespace opp::mapping
