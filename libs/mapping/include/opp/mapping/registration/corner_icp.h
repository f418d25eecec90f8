// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"
#include "opp/mapping/core/se3.h"
#include "opp/mapping/registration/corner_icp_params.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// The same corner's position in both scans [m].
struct CornerPair {
  Eigen::Vector3d in_target = Eigen::Vector3d::Zero();
  Eigen::Vector3d in_source = Eigen::Vector3d::Zero();
};

/// The set A_c of rigid motions that bring corresponding corners together best (Sommer et al. 2020,
/// Eq. 12), and its member closest to a first guess.
struct CornerConstraint {
  /// 6: no corner; 3: one (rotations about it); 1: two or more on a line (rotations about it);
  /// 0: three or more that are not on a line (Kabsch).
  int dof = 6;
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  Eigen::Vector3d pivot_in_target = Eigen::Vector3d::Zero();  ///< mean of the corners; dof < 6
  Eigen::Vector3d axis_in_target = Eigen::Vector3d::UnitZ();  ///< of the line; dof = 1
};

/// \param collinear_spread see CornerIcpParams
CornerConstraint cornerConstraint(const std::vector<CornerPair>& corners,
                                  const Eigen::Isometry3d& initial_target_from_source,
                                  double collinear_spread);

/// Outcome of `cornerIcp`.
struct CornerIcpResult {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  int dof = 6;            ///< parameters that were estimated from the points
  int iterations = 0;     ///< 0 if dof is 0: the corners alone decide
  bool converged = true;  ///< the last step was below the tolerances
  int matches = 0;        ///< points that correspond, at the result
  double rms = 0.0;       ///< of their point-to-plane distances [m]
  /// Inverse of the normal equations in the free directions, times the residuals' variance, of
  /// (ω, v), see `retract`; zero in directions that the corners fix.
  Matrix6d covariance = Matrix6d::Zero();
};

/// Point-to-plane ICP (Eq. 13) over A_c: 6, 3, 1 or 0 parameters for no, one, two (or collinear),
/// or more corners. Pass fewer corners to free more parameters; none for the unconstrained
/// baseline. Nearest neighbours by a kd-tree on the target. Without any correspondence: the start,
/// with 0 matches, not converged. Deterministic. Cost per step O(source · log target).
/// \throws std::invalid_argument if a parameter is out of range.
CornerIcpResult cornerIcp(const OrientedCloud& target, const OrientedCloud& source,
                          const std::vector<CornerPair>& corners,
                          const Eigen::Isometry3d& initial_target_from_source,
                          const CornerIcpParams& params);

}  // namespace opp::mapping
