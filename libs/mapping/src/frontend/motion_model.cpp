// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/motion_model.h"

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

Matrix6d informationOf(double rotation_sigma, double translation_sigma) {
  Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1.0 / (rotation_sigma * rotation_sigma)),
      Eigen::Vector3d::Constant(1.0 / (translation_sigma * translation_sigma));
  return diagonal.asDiagonal();
}

/// Stamps that are equal or run backwards must not give infinite velocities.
constexpr double kMinTimeStep = 1e-3;

}  // namespace

void MotionModel::update(const StampedPose& pose,
                         const std::optional<Eigen::Isometry3d>& odom_from_body) {
  before_last_ = last_;
  last_ = pose;
  last_odom_from_body_ = odom_from_body;
}

void MotionModel::correct(const Eigen::Isometry3d& last_pose) {
  if (!last_) return;
  const Eigen::Isometry3d new_from_old = last_pose * last_->map_from_body.inverse();
  last_->map_from_body = last_pose;
  if (before_last_)
    before_last_->map_from_body = normalized(new_from_old * before_last_->map_from_body);
}

PosePrior MotionModel::predict(double timestamp,
                               const std::optional<Eigen::Isometry3d>& odom_from_body) const {
  if (!last_) return {};
  if (odom_from_body && last_odom_from_body_) {
    return predictFromOdometry(last_odom_from_body_->inverse() * *odom_from_body);
  }
  return predictFromVelocity(timestamp);
}

PosePrior MotionModel::predictFromOdometry(const Eigen::Isometry3d& last_from_now) const {
  const double ratio = params_.odometry_noise_ratio;
  PosePrior prior;
  prior.map_from_body = normalized(last_->map_from_body * last_from_now);
  prior.information = informationOf(
      std::hypot(params_.odometry_noise_rotation, ratio * rotationAngle(last_from_now)),
      std::hypot(params_.odometry_noise_translation, ratio * last_from_now.translation().norm()));
  return prior;
}

PosePrior MotionModel::lastPose(double timestamp) const {
  if (!last_) return {};
  const double step = std::max(timestamp - last_->timestamp, kMinTimeStep);
  PosePrior prior;
  prior.map_from_body = last_->map_from_body;
  prior.information = informationOf(params_.angular_speed * step, params_.speed * step);
  return prior;
}

PosePrior MotionModel::predictFromVelocity(double timestamp) const {
  if (!before_last_) return lastPose(timestamp);
  const double step = std::max(timestamp - last_->timestamp, kMinTimeStep);
  PosePrior prior;
  const double past_step = std::max(last_->timestamp - before_last_->timestamp, kMinTimeStep);
  const Vector6d change = difference(before_last_->map_from_body, last_->map_from_body);
  prior.map_from_body = retract(last_->map_from_body, change * (step / past_step));
  // A velocity measured over past_step and a constant acceleration a: off by a·step·(step +
  // past_step)/2.
  const double error_time = 0.5 * step * (step + past_step);
  prior.information =
      informationOf(params_.angular_acceleration * error_time, params_.acceleration * error_time);
  return prior;
}

}  // namespace opp::mapping
