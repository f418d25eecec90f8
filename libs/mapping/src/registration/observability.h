// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/se3.h"

#include <Eigen/Core>

namespace opp::mapping {

/// The 99.9 % point of χ² with six degrees of freedom: a pose with more squared sigmas is
/// impossible.
inline constexpr double kPossible = 22.5;
/// Twice the logarithm of odds of 100 to 1: so many squared sigmas speak clearly against something.
inline constexpr double kClearly = 9.2;

/// Jacobian of the point-to-plane residual n·(p − m) by (ω, v), see `retract`. \param arm from the
/// body's origin to the point, in the map's frame [m]
inline Vector6d pointToPlaneJacobian(const Eigen::Vector3d& arm, const Eigen::Vector3d& normal) {
  Vector6d jacobian;
  jacobian << arm.cross(normal), normal;
  return jacobian;
}

/// What noisy normals add to the expectation of Σ w·J·Jᵀ over point-to-plane residuals, divided by
/// the variance of a normal about either tangent [rad²]. A noisy normal seems to tell of motion
/// along a smooth surface; this is how much of it is noise (errors in variables: Fuller 1987,
/// "Measurement Error Models").
class NormalNoise {
 public:
  /// Of a residual scale·n·(p − m). \param scaled_arm scale times the arm; \param jacobian scale
  /// times pointToPlaneJacobian(arm, normal). O(1).
  void add(double weight, const Eigen::Vector3d& scaled_arm, double scale,
           const Vector6d& jacobian) {
    squared_scales_ += weight * scale * scale;
    arms_ += weight * scale * scaled_arm;
    squared_arms_.noalias() += weight * scaled_arm * scaled_arm.transpose();
    seen_.noalias() += weight * jacobian * jacobian.transpose();
  }
  Matrix6d sum() const;

 private:
  double squared_scales_ = 0.0;
  Eigen::Vector3d arms_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squared_arms_ = Eigen::Matrix3d::Zero();
  Matrix6d seen_ = Matrix6d::Zero();
};

/// `hessian` less `noise`, with what becomes negative set to zero: the information that is left is
/// real. Directions are compared with rotations in units of 1/`range` rad, the turn that moves
/// points at that range [m] > 0 by a metre.
Matrix6d withoutNoise(const Matrix6d& hessian, const Matrix6d& noise, double range);

/// Turns (ω, v) from one frame's axes to another's.
inline Matrix6d turned(const Eigen::Matrix3d& to_from) {
  Matrix6d result = Matrix6d::Zero();
  result.topLeftCorner<3, 3>() = to_from;
  result.bottomRightCorner<3, 3>() = to_from;
  return result;
}

/// Information of (ω, v) in the axes of another frame.
inline Matrix6d informationIn(const Eigen::Matrix3d& from_frame, const Matrix6d& information) {
  const Matrix6d turn = turned(from_frame);
  return turn.transpose() * information * turn;
}

/// crossMatrix(a) * b = a × b.
Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& a);

/// (ω, v) of a body whose v is given at one point, with v at another that is `offset` away.
Matrix6d movedBy(const Eigen::Vector3d& offset);

/// Variance in the worst direction.
double largestVariance(const Eigen::Matrix3d& covariance);

/// Inverse of a covariance or of an information matrix that has full rank.
Matrix6d inverse(const Matrix6d& matrix);

/// Inverse of an information matrix; a direction without counts as known to 100 rad or 100 m.
Matrix6d covarianceOf(const Matrix6d& information);

}  // namespace opp::mapping
