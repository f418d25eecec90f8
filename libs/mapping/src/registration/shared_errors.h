// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/se3.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace opp::mapping {

/// How far a least-squares pose is off whose residuals were weighted one by one, while parts of
/// their errors are shared: that of each is its own noise plus deviations u g of sources with
/// g ~ N(0, 1).
class SharedErrors {
 public:
  struct Part {
    int source = 0;          ///< number of the source, from 0
    double deviation = 0.0;  ///< u, in the unit of the residual
  };

  /// A residual with d residual / d(ω, v) `jacobian`, the weight that it had in the estimate, and
  /// the variance of its own noise.
  void add(const Vector6d& jacobian, double weight, double variance,
           const std::array<Part, 2>& shared);

  /// Covariance of (ω, v): H⁻¹ Jᵀ W (V + U Uᵀ) W J H⁻¹ with H = Jᵀ W J. O(sources).
  Matrix6d covariance() const;

 private:
  Matrix6d hessian_ = Matrix6d::Zero();
  Matrix6d own_ = Matrix6d::Zero();   ///< Jᵀ W V W J
  std::vector<Vector6d> of_sources_;  ///< columns of Jᵀ W U
};

}  // namespace opp::mapping
