// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/trajectory.h"
#include "opp/mapping/evaluation/statistics.h"
#include "opp/mapping/evaluation/time_association.h"
#include "opp/params/field.h"

#include <Eigen/Geometry>

#include <string_view>

namespace opp::mapping {

/// How trajectories are compared.
struct TrajectoryErrorParams {
  static constexpr std::string_view kSection = "trajectory_error";
  AssociationParams association;
  /// Relative errors "per metre" are taken over stretches of this length.
  double rpe_distance = 1.0;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.rpe_distance, Field{"rpe_distance", "m", 1e-3, 1e6,
                            "path length over which the relative error per metre is taken"});
  }
};

/// Errors of an estimated trajectory against the true one (Sturm et al. 2012), translation and
/// rotation apart.
struct TrajectoryError {
  std::size_t gt_poses = 0;
  std::size_t est_poses = 0;
  std::size_t matched = 0;  ///< estimated poses that have a true pose
  /// Share of the true poses that have an estimated pose nearby in time: within ¾ of the median
  /// step of the estimate (less than one step, so that a missing frame counts as missing; more than
  /// half a step, so that truth at another rate or with jitter is covered), but at least
  /// `max_time_difference`. In [0, 1].
  double coverage = 0.0;
  double path_length = 0.0;  ///< of the true poses that were matched [m]
  Eigen::Isometry3d gt_from_est = Eigen::Isometry3d::Identity();  ///< see alignTrajectories
  /// Aligned by positions and orientations, see alignPoses: for maps that go with the trajectory.
  Eigen::Isometry3d gt_map_from_est_map = Eigen::Isometry3d::Identity();
  ErrorStatistics ate_translation;  ///< |p_gt − gt_from_est·p_est| [m]
  /// Angle between R_gt and R_est turned by gt_map_from_est_map [rad].
  ErrorStatistics ate_rotation;
  /// Error of the motion from one matched pose to the next; needs no alignment.
  ErrorStatistics rpe_frame_translation;  ///< [m]
  ErrorStatistics rpe_frame_rotation;     ///< [rad]
  /// Error of the motion over `rpe_distance` of true path, from each pose to the first one at least
  /// that far along the path, divided by the true length between them; empty if the path is
  /// shorter.
  ErrorStatistics rpe_metre_translation;  ///< [m/m]
  ErrorStatistics rpe_metre_rotation;     ///< [rad/m]
};

/// Compares two trajectories whose frames are unrelated. O((m + n) log(m + n)).
/// \throws std::invalid_argument if no estimated pose has a true one, if times do not ascend, or if
/// a pose is not finite.
TrajectoryError trajectoryError(const Trajectory& ground_truth, const Trajectory& estimate,
                                const TrajectoryErrorParams& params = {});

}  // namespace opp::mapping
