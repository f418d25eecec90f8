// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/solve_alone.h"

#include "opp/geometry/plane.h"

#include <Eigen/LU>

namespace opp {

bool solveAlone(const Eigen::Matrix3d& scatter, Eigen::Vector3d& normal) {
  StepDamping damping(normal.dot(scatter * normal), kEnergyRounding * scatter.trace());
  bool converged = false;
  for (int step_count = 0; step_count < kMaxSteps && !converged; ++step_count) {
    const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(normal);
    const Eigen::Matrix<double, 3, 2> spread = scatter * tangents;
    Eigen::Matrix2d information = tangents.transpose() * spread;
    information.diagonal() *= 1.0 + damping.value();
    information.diagonal().array() += kPriorInformation;
    const Eigen::Vector2d step = -information.inverse() * (spread.transpose() * normal);
    converged = step.lpNorm<Eigen::Infinity>() < kStepTolerance;
    const Eigen::Vector3d candidate = (normal + tangents * step).normalized();
    if (damping.accepts(candidate.dot(scatter * candidate))) normal = candidate;
  }
  return converged;
}

}  // namespace opp
