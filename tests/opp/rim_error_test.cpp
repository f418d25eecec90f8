// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/cloud/rim_error.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace opp {
namespace {

/// Least-squares line through heights at the middles of a row of patches.
struct Fit {
  double turn = 0.0, shift = 0.0, variance = 0.0;
};

Fit fitRow(const std::vector<double>& heights, double extent) {
  const auto n = static_cast<double>(heights.size());
  Fit fit;
  double slope = 0.0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double x = (static_cast<double>(i) + 0.5 - 0.5 * n) * extent;
    fit.shift += heights[i] / n;
    fit.variance += x * x / n;
    slope += x * heights[i] / n;
  }
  fit.turn = slope / fit.variance;
  return fit;
}

TEST(RimError, IsWhatRimsDoToAFit) {
  constexpr double kExtent = 0.02;
  for (const std::size_t patches : {20U, 50U, 200U}) {
    std::vector<double> heights(patches, 0.0);
    heights.back() = kExtent / 8.0;
    const Fit worst = fitRow(heights, kExtent);
    const RimError error = rimError(kExtent * kExtent, worst.variance);
    EXPECT_NEAR(worst.turn / error.turn, 1.0, 2.0 / static_cast<double>(patches));

    test::Random random(patches);
    double sum_of_squares = 0.0;
    constexpr int kTrials = 2000;
    for (int trial = 0; trial < kTrials; ++trial) {
      const double taken = random.uniform(0.0, 0.5);
      heights.front() = heights.back() = 0.5 * taken * taken * kExtent;
      sum_of_squares += std::pow(fitRow(heights, kExtent).shift, 2) / kTrials;
    }
    EXPECT_NEAR(std::sqrt(sum_of_squares) / error.shift, 1.0, 0.1);
  }
}

TEST(RimError, WithoutWidthNothingIsKnown) {
  EXPECT_EQ(rimError(1e-4, 0.0).turn, std::numeric_limits<double>::infinity());
  EXPECT_EQ(rimError(1e-4, 0.0).shift, std::numeric_limits<double>::infinity());
  EXPECT_EQ(rimError(0.0, 1e-4).turn, 0.0) << "points have no rims";
}

}  // namespace
}  // namespace opp
