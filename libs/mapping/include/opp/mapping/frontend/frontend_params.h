// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp::mapping {

/// Parameters of pose prediction, tracking and the choice of keyframes.
struct FrontendParams {
  static constexpr std::string_view kSection = "frontend";
  double acceleration = 1.5;
  double angular_acceleration = 5.0;
  /// Measured with constant velocities between true poses, in units of the typical accelerations
  /// (root mean square; most): translation .2 to .9 at 30 Hz and .1 to .3 at 3 Hz in recorded
  /// sequences held by hand (redwood .9 throughout), .2 (1.6) in simulated ones.
  double unrest_caution = 3.0;
  double least_unrest = 0.2;
  int unrest_memory = 15;
  double speed = 1.0;
  double angular_speed = 1.5;
  double odometry_noise_ratio = 0.05;
  double odometry_noise_translation = 0.002;
  double odometry_noise_rotation = degToRad(0.2);
  double min_overlap = 0.3;
  double doubtful_overlap = 0.6;
  double surprising_conflict = 0.2;
  double max_jump = 6.0;
  double max_drift_translation = 0.15;
  double max_drift_rotation = degToRad(3.0);
  double max_gap = 1.0;
  /// Of the leaps seen that motion calls impossible, the wrong one (a body that was carried to
  /// another room of the same kind) agreed with 0.64 of the scan, right ones (a lidar that turns by
  /// 40° from step to step) with 0.72 and more.
  double leap_overlap = 0.68;
  double keyframe_overlap = 0.9;
  double open_keyframe_overlap = 0.8;
  double keyframe_rotation = degToRad(25.0);
  int local_keyframes = 15;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.acceleration, Field{"acceleration", "m/s^2", 1e-3, 1e3,
                            "typical change of speed of the body (standard deviation)"});
    f(p.angular_acceleration,
      Field{"angular_acceleration", "rad/s^2", 1e-3, 1e3, "typical change of turning rate"});
    f(p.unrest_caution,
      Field{
          "unrest_caution", "", 1.0, 100.0,
          "a body is taken to change its motion so many times as much as it did of late (standard "
          "deviation), at most as a typical one"});
    f(p.least_unrest,
      Field{"least_unrest", "", 0.0, 1.0,
            "and at least by this share of what a typical one does; 1: as a typical "
            "one"});
    f(p.unrest_memory, Field{"unrest_memory", "", 1, 1e6, "scans that make up 'of late'"});
    f(p.speed, Field{"speed", "m/s", 1e-3, 1e3, "typical speed, while no velocity is known"});
    f(p.angular_speed, Field{"angular_speed", "rad/s", 1e-3, 1e3,
                             "typical turning rate, while no velocity is known"});
    f(p.odometry_noise_ratio, Field{"odometry_noise_ratio", "", 0.0, 1.0,
                                    "odometry error over the distance and angle moved"});
    f(p.odometry_noise_translation,
      Field{"odometry_noise_translation", "m", 1e-6, 1.0, "odometry error of a step, at least"});
    f(p.odometry_noise_rotation,
      Field{"odometry_noise_rotation", "rad", 1e-6, 1.0, "odometry error of a step, at least"});
    f(p.min_overlap, Field{"min_overlap", "", 0.0, 1.0,
                           "a scan of which a smaller share agrees with the map is lost"});
    f(p.doubtful_overlap,
      Field{"doubtful_overlap", "", 0.0, 1.0,
            "if a smaller share agrees, the last pose is tried beside the prediction"});
    f(p.surprising_conflict,
      Field{
          "surprising_conflict", "", 0.0, 1.0,
          "a body may have been carried off if so much of what speaks stands, where motion expects "
          "the scan, in free space"});
    f(p.max_jump,
      Field{"max_jump", "", 1.0, 1e6,
            "and lost if it moved since the last scan by so many times the typical speeds"});
    f(p.max_drift_translation,
      Field{"max_drift_translation", "m", 1e-4, 100.0,
            "a scan whose pose is less certain in any direction (standard deviation) is lost"});
    f(p.max_drift_rotation,
      Field{"max_drift_rotation", "rad", 1e-4, 3.1415, "and one that is about any axis"});
    f(p.max_gap,
      Field{"max_gap", "s", 1e-3, 1e3,
            "a body is not looked for in the same map once its place is predicted worse "
            "(standard deviation) than the typical speed takes it in this time, or in twice that "
            "between scans if they are farther apart"});
    f(p.leap_overlap,
      Field{"leap_overlap", "", 0.0, 1.0,
            "a scan of which a smaller share agrees is lost if motion says that the "
            "body cannot be there"});
    f(p.keyframe_overlap, Field{"keyframe_overlap", "", 0.0, 1.0,
                                "a scan of which a smaller share agrees becomes a keyframe"});
    f(p.open_keyframe_overlap,
      Field{"open_keyframe_overlap", "", 0.0, 1.0,
            "the same for a scan that leaves its pose open: what comes after such a keyframe is "
            "matched with it alone"});
    f(p.keyframe_rotation, Field{"keyframe_rotation", "rad", 0.01, 3.1415,
                                 "and one that looks so much away from the last keyframe"});
    f(p.local_keyframes, Field{"local_keyframes", "", 1, 1000, "keyframes in the local map"});
  }
};

}  // namespace opp::mapping
