// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/se3.h"

#include <Eigen/Core>

namespace opp::mapping {

/// Jacobian of the point-to-plane residual n·(p − m) by (ω, v), see `retract`. \param arm from the
/// body's origin to the point, in the map's frame [m]
inline Vector6d pointToPlaneJacobian(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal) {
  Vector6d jacobian;
  jacobian << arm.cross(normal), normal;
  return jacobian;
}

/// What a normal with variance σ² about either tangent [rad²] adds to the expectation of J·Jᵀ of a
/// point-to-plane residual, divided by σ². A noisy normal seems to tell of motion along a smooth
/// surface; this is how much of it is noise (errors in variables: Fuller 1987, "Measurement Error
/// Models").
Matrix6d normalNoise(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal);

/// `hessian` less `noise`, with what becomes negative set to zero: the information that is left is
/// real. Directions are compared with rotations in units of 1/`range` rad, the turn that moves
/// points at that range [m] > 0 by a metre.
Matrix6d withoutNoise(const Matrix6d& hessian, const Matrix6d& noise, double range);

/// Inverse of an information matrix; a direction without counts as known to 100 rad or 100 m.
Matrix6d covarianceOf(const Matrix6d& information);

}  // namespace opp::mapping
