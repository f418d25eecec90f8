// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/odometry.h"

#include "opp/mapping/simulation/seeded_random.h"

#include <cmath>

namespace opp::mapping {
namespace {

constexpr std::uint64_t kStream = 0x6F646F6D;  // "odom": not a frame's number

Eigen::Vector3d normalVector(SeededRandom& random) {
  const auto xy = random.normalPair();
  return {xy[0], xy[1], random.normal()};
}

}  // namespace

DriftingOdometry::DriftingOdometry(const OdometryModel& model, bool planar, std::uint64_t seed)
    : model_(model), planar_(planar), seed_(seed) {
  validate(model);
}

const Eigen::Isometry3d& DriftingOdometry::move(const Eigen::Isometry3d& old_body_from_body) {
  SeededRandom run(seed_, kStream, 0);
  const auto scale = run.normalPair();
  SeededRandom random(seed_, kStream, ++step_);
  const Eigen::AngleAxisd turn(old_body_from_body.linear());
  const double way = old_body_from_body.translation().norm();
  Eigen::Vector3d shift_error = model_.distance_noise * std::sqrt(way) * normalVector(random);
  Eigen::Vector3d turn_error = std::hypot(model_.turn_noise_per_distance * std::sqrt(way),
                                          model_.turn_noise_per_turn * std::sqrt(turn.angle())) *
                               normalVector(random);
  if (planar_) {
    shift_error.z() = 0.0;
    turn_error.head<2>().setZero();
  }
  const Eigen::Vector3d believed_turn =
      (1.0 + model_.scale_error * scale[1]) * turn.angle() * turn.axis() + turn_error;
  Eigen::Isometry3d increment = Eigen::Isometry3d::Identity();
  increment.translation() =
      (1.0 + model_.scale_error * scale[0]) * old_body_from_body.translation() + shift_error;
  if (believed_turn.norm() > 0.0) {
    increment.linear() =
        Eigen::AngleAxisd(believed_turn.norm(), believed_turn.normalized()).toRotationMatrix();
  }
  odom_from_body_ = odom_from_body_ * increment;
  return odom_from_body_;
}

}  // namespace opp::mapping
