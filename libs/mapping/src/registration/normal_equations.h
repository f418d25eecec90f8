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
  /// \param scaled_arm, scale see ScanPlane
  void addPlane(const Eigen::Vector3d& scaled_arm, double scale, const Eigen::Vector3d& normal,
                double residual, double weight) {
    add(scaled_arm, scale, normal, residual, weight, of_landmarks_);
  }
  NormalEquations equations(double surfel_normal_variance, double landmark_normal_variance) const {
    NormalEquations result = sums_;
    result.noise =
        surfel_normal_variance * of_surfels_.sum() + landmark_normal_variance * of_landmarks_.sum();
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
  NormalNoise of_surfels_, of_landmarks_;
};

}  // namespace opp::mapping
