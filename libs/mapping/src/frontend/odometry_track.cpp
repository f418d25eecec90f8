// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/odometry_track.h"

#include "opp/mapping/core/se3.h"

#include <cmath>

namespace opp::mapping {

void OdometryTrack::add(double timestamp, const Eigen::Isometry3d& odom_from_body) {
  if (last_ && timestamp > last_->timestamp) before_last_ = last_;
  last_ = StampedPose{timestamp, odom_from_body};
  if (before_last_ && before_last_->timestamp >= timestamp) before_last_.reset();
}

std::optional<Eigen::Isometry3d> OdometryTrack::at(double timestamp) const {
  if (!last_ || !(std::abs(timestamp - last_->timestamp) <= kMaxAge)) return std::nullopt;
  if (!before_last_) return last_->map_from_body;
  const double share =
      (timestamp - last_->timestamp) / (last_->timestamp - before_last_->timestamp);
  // In the body frame, so that a turning body goes on along its arc.
  const Eigen::Isometry3d step = before_last_->map_from_body.inverse() * last_->map_from_body;
  return last_->map_from_body * retract(Eigen::Isometry3d::Identity(),
                                        share * difference(Eigen::Isometry3d::Identity(), step));
}

}  // namespace opp::mapping
