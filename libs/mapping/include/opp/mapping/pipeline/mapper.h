// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/core/trajectory.h"
#include "opp/mapping/frontend/tracker.h"

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

/// Builds a map from scans in the order of time: prediction, registration against the local map,
/// keyframes, landmarks, optimization. The map's frame is the body frame of the first scan, unless
/// `setInitialPose` says otherwise. Deterministic.
class Mapper {
 public:
  explicit Mapper(const MapperParams& params);

  /// Pose of the first scan; to be called before the first `add`.
  void setInitialPose(const Eigen::Isometry3d& map_from_body) { initial_pose_ = map_from_body; }

  /// Takes the next scan. `odom_from_body`: the odometry's pose at its time, if the rawlog has any.
  /// A scan without samples is not localized.
  FrameResult add(ScanFeatures scan, const std::optional<Eigen::Isometry3d>& odom_from_body);

  /// Optimizes the whole map; to be called after the last scan.
  void finish();

  const MapState& map() const { return map_; }
  /// Poses of all localized scans, with all that was learned after them.
  Trajectory trajectory() const;
  /// The same poses by ScanFeatures::scan_index.
  std::map<std::size_t, Eigen::Isometry3d> poses() const;

 private:
  /// A localized scan follows the keyframe that was the newest when it came.
  struct Follower {
    double timestamp;
    std::size_t scan_index;
    int keyframe;
    Eigen::Isometry3d keyframe_from_body;
  };

  FrameResult start(ScanFeatures scan, const std::optional<Eigen::Isometry3d>& odom_from_body);
  void addKeyframe(ScanFeatures scan, const MatchResult& match);
  void follow(double timestamp, std::size_t scan_index, const Eigen::Isometry3d& map_from_body);
  Eigen::Isometry3d poseOf(const Follower& follower) const;
  void optimize(int first_free);

  MapperParams params_;
  Eigen::Isometry3d initial_pose_ = Eigen::Isometry3d::Identity();
  MapState map_;
  Tracker tracker_;
  std::vector<Follower> followers_;
};

}  // namespace opp::mapping
