// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/params/field.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// Where the body passes and looks. Angles as in yaw about z, then pitch about the turned y: with
/// positive pitch the body looks down.
struct Waypoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the map [m]
  double yaw = 0.0;                                    ///< [rad]
  double pitch = 0.0;                                  ///< [rad]
};

/// How somebody carries a sensor.
struct HandMotion {
  static constexpr std::string_view kSection = "motion";
  double speed = 0.45;
  double turn_rate = 0.52;  // 30°/s
  double jitter_position = 0.004;
  double jitter_angle = 0.006;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.speed, Field{"speed", "m/s", 0.01, 100.0, "where it walks"});
    f(p.turn_rate, Field{"turn_rate", "rad/s", 0.01, 10.0, "where it turns"});
    f(p.jitter_position, Field{"jitter_position", "m", 0.0, 0.1, "amplitude of the unrest"});
    f(p.jitter_angle, Field{"jitter_angle", "rad", 0.0, 0.1, "amplitude of the unrest"});
  }
};

/// Smooth path through way-points (centripetal Catmull–Rom spline: passes through each, without
/// loops), walked at `speed` or as slow as `turn_rate` demands, with a hand's unrest of 0.3–2 Hz.
class HandPath {
 public:
  /// \throws std::invalid_argument if there are fewer than two way-points, one is not finite, all
  /// are equal, or a parameter is out of range.
  HandPath(std::vector<Waypoint> waypoints, const HandMotion& motion, std::uint64_t seed);

  double duration() const { return times_.back(); }  ///< of one pass [s]
  /// Whether the last way-point equals the first, so that passes can follow each other.
  bool closed() const;
  /// Pose at `time` [s] ≥ 0. Beyond duration() the path begins anew (the unrest does not).
  Eigen::Isometry3d mapFromBody(double time) const;

 private:
  using Knot = Eigen::Matrix<double, 5, 1>;  ///< x, y, z, yaw, pitch
  Knot pointAt(double parameter) const;
  void buildTimeTable();
  Eigen::Isometry3d unrest(double time) const;

  HandMotion motion_;
  std::uint64_t seed_;
  std::vector<Knot> knots_;         ///< with one mirrored knot before and after
  std::vector<double> parameters_;  ///< of the knots
  std::vector<double> times_;       ///< at evenly spaced parameters
};

}  // namespace opp::mapping
