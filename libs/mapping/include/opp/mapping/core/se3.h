// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace opp::mapping {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Moves a pose by (ω, v), both in the parent frame: R ← Exp(ω) R, t ← t + v. Rotation and
/// translation are kept apart (no SE(3) coupling), so that their units stay separate in every
/// covariance.
Eigen::Isometry3d retract(const Eigen::Isometry3d& a_from_b, const Vector6d& omega_v);

/// The (ω, v) that takes `from` to `to`: retract(from, difference(from, to)) = to.
Vector6d difference(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

/// The same pose with its rotation projected back onto SO(3); composing thousands of poses without
/// this diverges.
Eigen::Isometry3d normalized(const Eigen::Isometry3d& pose);

/// Angle of the rotation in [0, π] [rad].
double rotationAngle(const Eigen::Isometry3d& pose);

}  // namespace opp::mapping
