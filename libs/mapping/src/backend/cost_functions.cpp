// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "backend/cost_functions.h"

#include <Eigen/Eigenvalues>

namespace opp::mapping {

RelativePoseCost::RelativePoseCost(const RelativePoseFactor& factor)
    : rotation_(factor.first_from_second.linear()),
      translation_(factor.first_from_second.translation()) {
  // Symmetric square root: exists for rank-deficient information too (directions the points do not
  // fix).
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(
      0.5 * (factor.information + factor.information.transpose()));
  sqrt_information_ = eigen.eigenvectors() *
                      eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                      eigen.eigenvectors().transpose();
}

}  // namespace opp::mapping
