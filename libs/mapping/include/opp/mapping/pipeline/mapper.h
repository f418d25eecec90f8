// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/core/trajectory.h"
#include "opp/mapping/frontend/passage_watch.h"
#include "opp/mapping/frontend/tracker.h"
#include "opp/mapping/loop/close_loops.h"
#include "opp/mapping/loop/map_part.h"

#include <map>
#include <optional>
#include <vector>

namespace opp::mapping {

/// What became of one scan.
struct FrameResult {
  bool localized = false;
  bool is_keyframe = false;
  double overlap = 0.0;  ///< see MatchResult
  double rms = 0.0;      ///< [m]
};

/// Builds maps from scans in the order of time: prediction, registration against the local map,
/// keyframes, landmarks, optimization, loop closure.
///
/// A session and a body that is lost begin a new part. In the end, when all is known, parts join
/// that are proven to show the same place (`joinParts`); the others stay maps of their own. The
/// frame of a part is the body frame of its first scan, unless `setInitialPose` says otherwise; a
/// part that was tied too loosely to another stays in that one's frame, about where it belongs.
/// Deterministic.
class Mapper {
 public:
  explicit Mapper(const MapperParams& params);

  /// The next scan continues nothing that came before: another rawlog.
  void startSession() { continues_ = false; }
  /// Pose of the very first scan; to be called before the first `add`.
  void setInitialPose(const Eigen::Isometry3d& map_from_body) { initial_pose_ = map_from_body; }

  /// Takes the next scan. `odom_from_body`: the odometry's pose at its time, if the rawlog has any.
  /// A scan without samples is not localized.
  FrameResult add(ScanFeatures scan, const std::optional<Eigen::Isometry3d>& odom_from_body);

  /// Lets floors be level beyond what ties maps loosely, takes parts asunder and leaves out scans
  /// where they are tied so loosely that poses would be invented, joins those that are proven to
  /// belong together, looks whether what joined ties better what was taken asunder, optimizes each
  /// as a whole, lets scans between keyframes add what they saw, and gives up parts that are too
  /// small; to be called after the last scan. Same result for every `threads`.
  void finish(int threads = 1);

  /// The parts that stayed apart, after `finish` those with most scans first; empty before the
  /// first scan.
  const std::vector<MapPart>& parts() const { return parts_; }
  /// The part with most scans, after `finish`; an empty map if there is none.
  const MapState& map() const;

 private:
  friend struct StateAccess;  // checkpoints
  MapState& active() { return parts_.back().map; }
  FrameResult begin(ScanFeatures scan, const std::optional<Eigen::Isometry3d>& odom_from_body);
  std::optional<ExpectedBeginning> expectedBeginning(
      const ScanFeatures& scan, const std::optional<Eigen::Isometry3d>& odom_from_body) const;
  void insert(ScanFeatures scan, const MatchResult& match);
  /// Optimizes what is around the newest keyframe, looks for loops, and goes on from there.
  void settleNewest();
  /// Adds a keyframe.
  void addTracked(ScanFeatures scan, const TrackResult& track, FollowedScan followed);
  /// Keyframes that a map ties no worse than this stay in it, see `tiedSets` [m²].
  double maxOpenVariance() const;
  void splitParts();
  /// Adds a scan between keyframes; returns its place in MapState::scans.
  std::size_t follow(const ScanFeatures& scan, const MatchResult& match);
  /// Whether the scan alone leaves its pose open.
  bool isOpen(const MatchResult& match) const;

  MapperParams params_;
  Eigen::Isometry3d initial_pose_ = Eigen::Isometry3d::Identity();
  Tracker tracker_;
  LoopCloser loop_closer_;
  std::vector<MapPart> parts_;  ///< the last one is being built
  PassageWatch passages_;       ///< of the part that is being built
  std::vector<int> local_;      ///< keyframes that scans are registered against
  MapState empty_;
  bool continues_ = false;
  int lost_in_a_row_ = 0;
  int next_part_ = 0;
};

/// Poses of all localized scans, in the order of time, with all that was learned after them.
Trajectory trajectoryOf(const MapState& map);

/// The same poses of one session, by ScanFeatures::scan_index.
std::map<std::size_t, Eigen::Isometry3d> posesOf(const MapState& map, int session);

}  // namespace opp::mapping
