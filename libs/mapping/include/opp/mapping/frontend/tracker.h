// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/frontend/lost_scans.h"
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
  kContradicted,   ///< what agrees is outweighed by what stands where the other looked through
  /// The body cannot have moved so since the last scan; or this is far from where motion puts it,
  /// and the map denied that before, or agrees clearly better with it now; or the scans that were
  /// lost on the way say so.
  kImplausible,
  kUnobserved,  ///< a direction has not been seen for so long that no prediction can be trusted
  kForgotten,   ///< lost for so long that the body may have turned around
};

/// One line for reports.
std::string_view describe(TrackOutcome outcome);

/// What the tracker makes of one scan.
struct TrackResult {
  TrackOutcome outcome = TrackOutcome::kNoMap;
  bool wants_keyframe = false;  ///< the map would gain by this scan; false if not followed
  MatchResult match;            ///< of the best attempt, also if it was not good enough
  /// What motion since the newest keyframe added to `match.point_information`.
  Matrix6d motion_information = Matrix6d::Zero();

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
  /// localized leaves the tracker as it was, but for the time that goes by; one that only leaves a
  /// direction open (kUnobserved) still tells how the body moved in the others.
  TrackResult track(const ScanFeatures& scan,
                    const std::optional<Eigen::Isometry3d>& odom_from_body, const MapState& map);

  /// Where the body should be at `timestamp`, unless it was lost because the map shows something
  /// else there: a body that was carried off is not where motion expects it.
  std::optional<PosePrior> expected(double timestamp,
                                    const std::optional<Eigen::Isometry3d>& odom_from_body) const;

  /// Scans are registered against this from now on (see `localMapOf`). To be called after keyframes
  /// or landmarks changed.
  void setLocalMap(LocalMap local_map) { local_map_ = std::move(local_map); }

  /// The last scan became the newest keyframe, and optimization took it to `last_pose`.
  void correct(const Eigen::Isometry3d& last_pose) {
    follows_ = true;
    motion_.correct(last_pose);
    motion_.setAnchor();
  }

  /// What is known of how the body moves.
  const MotionModel& motion() const { return motion_; }

 private:
  friend struct StateAccess;  // checkpoints
  /// \param moved the most that is known of the motion since the last localized scan
  TrackResult localize(const ScanFeatures& scan, const PosePrior& predicted, const PosePrior& moved,
                       const Keyframe& newest) const;
  std::optional<PosePrior> relocalize(const ScanFeatures& scan, const PosePrior& last,
                                      const Keyframe& newest) const;
  /// Whether motion clearly speaks against a pose that is not even near where it expects the body.
  bool leaps(const Eigen::Isometry3d& map_from_body, const PosePrior& predicted,
             const ScanFeatures& scan) const;
  /// The scan registered near where motion expects it; nothing if something contradicts that. What
  /// is new in a scan may resemble what is known (the next corner of a room the last one), and that
  /// the scan agrees less where it is expected is no reason to leap.
  std::optional<MatchResult> whereExpected(const ScanFeatures& scan, const PosePrior& predicted,
                                           const Keyframe& newest) const;
  bool guides(const PosePrior& predicted) const;
  /// Takes note of how far apart scans are.
  void takeTime(double timestamp);
  bool convincing(const MatchResult& match) const;
  TrackOutcome outcomeOf(const MatchResult& match, const ScanFeatures& scan, const PosePrior& moved,
                         const Keyframe& newest) const;
  bool contradicts(const Eigen::Isometry3d& map_from_body, const ScanFeatures& scan,
                   const Keyframe& newest) const;
  /// Whether a pose that was well predicted contradicts the scan: the body was moved.
  bool surprises(const PosePrior& predicted, const ScanFeatures& scan,
                 const Keyframe& newest) const;
  /// Whether registration left a likely pose for an impossible one, not even near it, that explains
  /// little of the scan or leaves a direction open, or agrees clearly less.
  bool slidAway(const MatchResult& match, TrackOutcome outcome, const PosePrior& predicted,
                const ScanFeatures& scan, const Keyframe& newest) const;
  /// Whether a body that surprised before is back on its way.
  bool resumes(const Eigen::Isometry3d& map_from_body, const PosePrior& predicted,
               const ScanFeatures& scan, const Keyframe& newest) const;
  bool wantsKeyframe(const MatchResult& match, const Keyframe& newest) const;

  MapperParams params_;
  MotionModel motion_;
  std::optional<LocalMap> local_map_;
  double last_scan_ = 0.0;         ///< time of the last scan, localized or not [s]
  std::vector<double> intervals_;  ///< between the scans of late [s]
  std::vector<LostScan> lost_;     ///< newest of those since the last localized one
  bool follows_ = true;            ///< the last scan was localized
  bool surprised_ = false;         ///< the scan after that contradicted the map where motion put it
};

/// Of several poses that explain a scan alike, the one that motion speaks for by odds of 100 to 1
/// against each other one; nothing if none is, if motion denies it, or if there are no poses.
std::optional<Eigen::Isometry3d> likeliest(const std::vector<Eigen::Isometry3d>& poses,
                                           const PosePrior& prior);

}  // namespace opp::mapping
