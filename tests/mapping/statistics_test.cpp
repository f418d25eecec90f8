// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/statistics.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace opp::mapping {
namespace {

TEST(Statistics, WorkedExample) {
  const ErrorStatistics s = statisticsOf({4.0, 1.0, 3.0, 2.0});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(30.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.p90, 3.7);  // position 0.9·3 = 2.7 between 3 and 4
  EXPECT_DOUBLE_EQ(s.max, 4.0);
}

TEST(Statistics, OneValueIsAllOfThem) {
  const ErrorStatistics s = statisticsOf({2.0});
  for (const double value : {s.rmse, s.mean, s.median, s.p90, s.max}) EXPECT_EQ(value, 2.0);
}

TEST(Statistics, NothingGivesCountZero) {
  const ErrorStatistics s = statisticsOf({});
  EXPECT_EQ(s.count, 0u);
  EXPECT_EQ(s.max, 0.0);
}

TEST(Statistics, RejectsWhatIsNotFinite) {
  EXPECT_THROW(statisticsOf({1.0, std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
}

TEST(Statistics, AreOrderedForRandomErrors) {
  test::Random random(41);
  for (int k = 0; k < 50; ++k) {
    std::vector<double> errors(static_cast<std::size_t>(random.integer(1, 40)));
    for (double& e : errors) e = random.uniform(0.0, 10.0);
    const ErrorStatistics s = statisticsOf(errors);
    EXPECT_LE(s.mean, s.rmse + 1e-12);
    EXPECT_LE(s.median, s.p90);
    EXPECT_LE(s.p90, s.max);
    EXPECT_LE(s.rmse, s.max + 1e-12);
  }
}

}  // namespace
}  // namespace opp::mapping
