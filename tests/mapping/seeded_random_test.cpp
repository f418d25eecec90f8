// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/seeded_random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

TEST(SeededRandom, GivesTheSameNumbersOnEveryMachine) {
  SeededRandom random(1, 2, 3);
  const std::uint64_t first = random.bits();
  SeededRandom again(1, 2, 3);
  EXPECT_EQ(again.bits(), first);
  EXPECT_NE(SeededRandom(1, 2, 4).bits(), first);
  EXPECT_NE(SeededRandom(1, 3, 3).bits(), first);
  EXPECT_NE(SeededRandom(2, 2, 3).bits(), first);
}

TEST(SeededRandom, NeighbouringStreamsAreIndependentNormalNumbers) {
  const int count = 100000;
  double sum = 0.0, squares = 0.0, product = 0.0, fourth = 0.0, last = 0.0;
  for (int i = 0; i < count; ++i) {
    const double x = SeededRandom(7, 0, static_cast<std::uint64_t>(i)).normal();
    sum += x, squares += x * x, fourth += x * x * x * x, product += x * last;
    last = x;
  }
  // Four standard deviations: of the mean 1/√n, the variance √(2/n), the correlation 1/√n and the
  // fourth moment √(96/n).
  const double bound = 4.0 / std::sqrt(count);
  EXPECT_NEAR(sum / count, 0.0, bound);
  EXPECT_NEAR(squares / count, 1.0, bound * std::sqrt(2.0));
  EXPECT_NEAR(product / count, 0.0, bound);
  EXPECT_NEAR(fourth / count, 3.0, bound * std::sqrt(96.0));
}

TEST(SeededRandom, UniformNumbersFillTheUnitInterval) {
  SeededRandom random(1, 1, 1);
  double least = 1.0, most = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const double x = random.uniform();
    least = std::min(least, x), most = std::max(most, x);
  }
  EXPECT_GE(least, 0.0);
  EXPECT_LT(least, 0.01);
  EXPECT_LT(most, 1.0);
  EXPECT_GT(most, 0.99);
}

}  // namespace
}  // namespace opp::mapping
