// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/drawing_numbers.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

TEST(DrawingNumbers, AreShortAndHaveNoNegativeZero) {
  EXPECT_EQ(svgNumber(12.34), "12.3");
  EXPECT_EQ(svgNumber(-0.04), "0");
  EXPECT_EQ(fixedNumber(1.0, 3), "1.000");
  EXPECT_EQ(fixedNumber(-0.0004, 3), "0.000");
  EXPECT_EQ(fixedNumber(-1234.56, 0), "-1235");
  EXPECT_EQ(fixedNumber(1e308, 1).size(), 311U);
}

TEST(DrawingNumbers, RoundStepIsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(roundStep(1.0), 1.0);
  EXPECT_DOUBLE_EQ(roundStep(1.99), 1.0);
  EXPECT_DOUBLE_EQ(roundStep(0.3), 0.2);
  EXPECT_DOUBLE_EQ(roundStep(70.0), 50.0);
  test::Random random(4);
  for (int i = 0; i < 50; ++i) {
    const double wanted = std::pow(10.0, random.uniform(-6.0, 6.0));
    EXPECT_LE(roundStep(wanted), wanted);
    EXPECT_GT(2.5 * roundStep(wanted), wanted);
  }
}

}  // namespace
}  // namespace opp::mapping
