// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/trajectory.h"
#include "opp/mapping/evaluation/align.h"
#include "opp/params/field.h"

#include <optional>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// When a true and an estimated pose are of the same moment.
struct AssociationParams {
  static constexpr std::string_view kSection = "association";
  /// Motion capture runs at 100 Hz or more and simulators at the rate of the sensor; over a longer
  /// gap a straight line between two poses is no truth.
  double max_interpolation_gap = 0.1;
  /// Within this the nearest true pose is taken as it is, where interpolation is not possible.
  double max_time_difference = 0.01;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.max_interpolation_gap, Field{"max_interpolation_gap", "s", 0.0, 10.0,
                                     "true poses up to this far apart are interpolated between"});
    f(p.max_time_difference, Field{"max_time_difference", "s", 0.0, 10.0,
                                   "else the nearest true pose within this is taken"});
  }
};

/// The true pose at a moment: linear (translation) and spherical linear (rotation) between its two
/// neighbours if they are at most `max_interpolation_gap` apart, else the nearest one within
/// `max_time_difference`, else nothing. At the time of a true pose: that pose exactly. O(log n).
std::optional<Eigen::Isometry3d> poseAt(const Trajectory& trajectory, double timestamp,
                                        const AssociationParams& params);

/// Each estimated pose with the true pose of its moment, in the order of `estimate`; estimated
/// poses that have none are left out. Both trajectories are in ascending order of time. O(m log n).
/// \throws std::invalid_argument if a trajectory is not in ascending order of time or the
/// parameters are out of range.
std::vector<PosePair> associateByTime(const Trajectory& ground_truth, const Trajectory& estimate,
                                      const AssociationParams& params);

}  // namespace opp::mapping
