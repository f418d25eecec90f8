// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/trajectory.h"
#include "opp/mapping/frontend/frontend_params.h"
#include "opp/mapping/registration/match_scan.h"

#include <optional>

namespace opp::mapping {

/// Predicts the next pose: by the rawlog's odometry where there is one, else by constant velocity,
/// with an uncertainty that grows with the time since the last known pose.
class MotionModel {
 public:
  explicit MotionModel(const FrontendParams& params) : params_(params) {}

  /// Takes note of the pose of a localized scan. `odom_from_body`: the odometry's pose at that
  /// time.
  void update(const StampedPose& pose, const std::optional<Eigen::Isometry3d>& odom_from_body);

  /// Where the body should be at `timestamp`. Before the first update: the identity, nothing known.
  PosePrior predict(double timestamp, const std::optional<Eigen::Isometry3d>& odom_from_body) const;

  /// The last known pose, as uncertain as the typical speeds allow at `timestamp`: for a body that
  /// did something unexpected.
  PosePrior lastPose(double timestamp) const;

  /// The map has moved by an optimization: past poses are re-expressed so that the last one is
  /// `last_pose`.
  void correct(const Eigen::Isometry3d& last_pose);

 private:
  PosePrior predictFromOdometry(const Eigen::Isometry3d& last_from_now) const;
  PosePrior predictFromVelocity(double timestamp) const;

  FrontendParams params_;
  std::optional<StampedPose> last_;
  std::optional<StampedPose> before_last_;
  std::optional<Eigen::Isometry3d> last_odom_from_body_;
};

}  // namespace opp::mapping
