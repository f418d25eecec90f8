// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/frontend/motion_model.h"
#include "opp/mapping/registration/local_map.h"
#include "opp/mapping/registration/match_scan.h"

#include <optional>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// Why a scan has a pose, or has none.
enum class TrackOutcome {
  kLocalized,
  kEmptyScan,      ///< no samples
  kNoMap,          ///< nothing to be localized in: `Tracker::start` and `setLocalMap` come first
  kLittleOverlap,  ///< too small a share of the scan agrees with the map
};

/// One line for reports.
std::string_view describe(TrackOutcome outcome);

/// What the tracker makes of one scan.
struct TrackResult {
  TrackOutcome outcome = TrackOutcome::kNoMap;
  bool wants_keyframe = false;  ///< the map would gain by this scan; false if not localized
  MatchResult match;            ///< of the best attempt, also if it was not good enough

  bool localized() const { return outcome == TrackOutcome::kLocalized; }
};

/// Follows a body through a map: predicts its pose, registers each scan against the keyframes
/// around, and says which scans are localized and which should become keyframes. It only reads the
/// map; who adds keyframes or optimizes calls `setLocalMap` and `correct` afterwards.
/// Deterministic.
class Tracker {
 public:
  explicit Tracker(const MapperParams& params);

  /// The body is at `pose`; what was known of its motion before is forgotten. `odom_from_body`: the
  /// odometry's pose at that time, if there is any.
  void start(const StampedPose& pose, const std::optional<Eigen::Isometry3d>& odom_from_body);

  /// Localizes the next scan in the local map (of `map`, see `setLocalMap`). A scan that is not
  /// localized leaves the tracker as it was, but for the time that goes by.
  TrackResult track(const ScanFeatures& scan,
                    const std::optional<Eigen::Isometry3d>& odom_from_body, const MapState& map);

  /// Scans are registered against this from now on (see `localMapOf`). To be called after keyframes
  /// or landmarks changed.
  void setLocalMap(LocalMap local_map) { local_map_ = std::move(local_map); }

  /// The map moved and took the last localized pose to `last_pose`.
  void correct(const Eigen::Isometry3d& last_pose) { motion_.correct(last_pose); }

 private:
  MatchResult localize(const ScanFeatures& scan, const PosePrior& predicted,
                       const Keyframe& newest) const;
  MatchResult relocalize(const ScanFeatures& scan, const Keyframe& newest) const;
  bool wantsKeyframe(const MatchResult& match, const Keyframe& newest) const;

  MapperParams params_;
  MotionModel motion_;
  std::optional<LocalMap> local_map_;
};

}  // namespace opp::mapping
