// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/params/field.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <string_view>

namespace opp::mapping {

/// Odometry that drifts: each increment of motion gets a scale error that stays the same for the
/// whole run and noise whose variance grows with the length of the way and the angle turned (the
/// odometry motion model of Thrun, Burgard & Fox, Probabilistic Robotics, 2005, section 5.4).
struct OdometryModel {
  static constexpr std::string_view kSection = "odometry";
  double scale_error = 0.01;
  double distance_noise = 0.01;
  double turn_noise_per_distance = 0.01;
  double turn_noise_per_turn = 0.01;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.scale_error, Field{"scale_error", "", 0.0, 0.5, "of way and angle (1 sigma over runs)"});
    f(p.distance_noise,
      Field{"distance_noise", "", 0.0, 1.0, "m of error after 1 m of way; grows with its root"});
    f(p.turn_noise_per_distance,
      Field{"turn_noise_per_distance", "", 0.0, 1.0, "rad after 1 m of way; grows with its root"});
    f(p.turn_noise_per_turn,
      Field{"turn_noise_per_turn", "", 0.0, 1.0, "rad after 1 rad of turn; grows with its root"});
  }
};

/// Sums up noisy increments. Starts at the identity.
class DriftingOdometry {
 public:
  /// \param planar errors in x, y and yaw only. \throws std::invalid_argument if a parameter is out
  /// of range.
  DriftingOdometry(const OdometryModel& model, bool planar, std::uint64_t seed);

  /// Adds a true increment and returns the pose that the odometry believes in.
  const Eigen::Isometry3d& move(const Eigen::Isometry3d& old_body_from_body);
  const Eigen::Isometry3d& odomFromBody() const { return odom_from_body_; }

 private:
  OdometryModel model_;
  bool planar_;
  std::uint64_t seed_;
  std::uint64_t step_ = 0;
  Eigen::Isometry3d odom_from_body_ = Eigen::Isometry3d::Identity();
};

}  // namespace opp::mapping
