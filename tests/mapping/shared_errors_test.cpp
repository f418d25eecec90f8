// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/shared_errors.h"

#include "support/random.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace opp::mapping {
namespace {

/// `count` measurements of 6 numbers with errors shared by `sources` sources.
struct Problem {
  SharedErrors errors;
  Eigen::MatrixXd jacobian, deviations;
  Eigen::VectorXd weights, variances;

  Problem(int count, int sources, test::Random& random)
      : jacobian(count, 6),
        deviations(Eigen::MatrixXd::Zero(count, sources)),
        weights(count),
        variances(count) {
    for (int i = 0; i < count; ++i) {
      Vector6d row;
      for (int k = 0; k < 6; ++k) row[k] = random.normal();
      weights[i] = random.uniform(0.5, 2.0);
      variances[i] = random.uniform(0.5, 2.0);
      std::array<SharedErrors::Part, 2> parts{};
      for (auto& part : parts) {
        part = {random.integer(0, sources - 1), random.normal(3.0)};
        deviations(i, part.source) += part.deviation;
      }
      jacobian.row(i) = row;
      errors.add(row, weights[i], variances[i], parts);
    }
  }

  /// Of the estimate (Jᵀ W J)⁻¹ Jᵀ W r, by the covariance of all residuals.
  Matrix6d expected() const {
    Eigen::MatrixXd covariance = deviations * deviations.transpose();
    covariance.diagonal() += variances;
    const Eigen::MatrixXd weighted = weights.asDiagonal() * jacobian;
    const Matrix6d inverse = (jacobian.transpose() * weighted).inverse();
    return inverse * weighted.transpose() * covariance * weighted * inverse;
  }
};

TEST(SharedErrors, GiveTheCovarianceThatAllResidualsTogetherHave) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    const Problem p(40, 7, random);
    EXPECT_LT((p.errors.covariance() - p.expected()).norm(), 1e-9 * p.expected().norm()) << seed;
  }
}

TEST(SharedErrors, DoNotAverageOut) {
  SharedErrors errors;
  for (int i = 0; i < 10000; ++i) {
    for (int k = 0; k < 6; ++k) errors.add(Vector6d::Unit(k), 1e4, 1e-4, {{{k, 0.02}, {6, 0.0}}});
  }
  EXPECT_NEAR(errors.covariance()(3, 3), 0.02 * 0.02, 1e-7);
  EXPECT_NEAR(errors.covariance()(3, 4), 0.0, 1e-12);
}

}  // namespace
}  // namespace opp::mapping
