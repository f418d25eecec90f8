// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/se3.h"

#include "registration/observability.h"
#include "registration/point_matches.h"

#include <Eigen/Geometry>

namespace opp::mapping {

/// Normal equations of one Gauss–Newton step in (ω, v), with what the step saw.
struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  Matrix6d noise = Matrix6d::Zero();  ///< in the hessian, of the normals of surfels and landmarks
};

/// Gathers normal equations over the residuals of points and planes.
class Residuals {
 public:
  void addPoint(const PointMatch& match, double weight) {
    NormalNoise& noise = match.landmark < 0 ? of_surfels_ : of_landmarks_;
    add(match.arm, 1.0, match.normal, match.residual, weight, noise);
  }
  void addRim(const PointMatch& match, double weight) {
    add(match.arm, 1.0, match.normal, match.residual, weight, of_rims_);
  }
  /// \param scaled_arm, scale see ScanPlane
  void addPlane(const Eigen::Vector3d& scaled_arm, double scale, const Eigen::Vector3d& normal,
                double residual, double weight) {
    add(scaled_arm, scale, normal, residual, weight, of_landmarks_);
  }
  /// The variances of normals are about either tangent [rad²].
  NormalEquations equations(double of_surfels, double of_landmarks, double of_rims) const {
    NormalEquations result = sums_;
    result.noise = of_surfels * of_surfels_.sum() + of_landmarks * of_landmarks_.sum() +
                   of_rims * of_rims_.sum();
    return result;
  }

 private:
  void add(const Eigen::Vector3d& scaled_arm, double scale, const Eigen::Vector3d& normal,
           double residual, double weight, NormalNoise& noise) {
    Vector6d jacobian;
    jacobian << scaled_arm.cross(normal), scale * normal;
    sums_.hessian.noalias() += weight * jacobian * jacobian.transpose();
    sums_.gradient.noalias() += weight * residual * jacobian;
    noise.add(weight, scaled_arm, scale, jacobian);
  }

  NormalEquations sums_;
  NormalNoise of_surfels_, of_landmarks_, of_rims_;
};

}  // namespace opp::mapping
