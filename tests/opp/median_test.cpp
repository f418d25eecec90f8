// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/median.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp {
namespace {

TEST(Median, IsTheMiddleValueOrTheUpperOneOfTwo) {
  EXPECT_EQ(medianOf<double>({5.0}), 5.0);
  EXPECT_EQ(medianOf<double>({9.0, -1.0, 4.0}), 4.0);
  EXPECT_EQ(medianOf<float>({4.0F, 1.0F, 3.0F, 2.0F}), 3.0F);
}

TEST(Median, HasAsManyValuesBelowAsAbove) {
  test::Random random(1);
  for (std::size_t n = 1; n < 60; ++n) {
    std::vector<double> values(n);
    for (double& value : values) value = random.uniform(-1.0, 1.0);
    const double median = medianOf(values);
    const auto below =
        std::count_if(values.begin(), values.end(), [&](double value) { return value < median; });
    EXPECT_EQ(static_cast<std::size_t>(below), n / 2) << n << " values";
  }
}

}  // namespace
}  // namespace opp
