// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/shared_errors.h"

#include <Eigen/LU>

#include <cstddef>

namespace opp::mapping {

void SharedErrors::add(const Vector6d& jacobian, double weight, double variance,
                       const std::array<Part, 2>& shared) {
  const Vector6d weighted = weight * jacobian;
  hessian_.noalias() += weighted * jacobian.transpose();
  own_.noalias() += variance * weighted * weighted.transpose();
  for (const Part& part : shared) {
    const auto source = static_cast<std::size_t>(part.source);
    if (source >= of_sources_.size()) of_sources_.resize(source + 1, Vector6d::Zero());
    of_sources_[source] += part.deviation * weighted;
  }
}

Matrix6d SharedErrors::covariance() const {
  Matrix6d scattered = own_;
  for (const Vector6d& source : of_sources_) scattered.noalias() += source * source.transpose();
  const Matrix6d inverse = hessian_.inverse();
  return inverse * scattered * inverse;
}

}  // namespace opp::mapping
