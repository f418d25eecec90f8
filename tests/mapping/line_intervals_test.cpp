// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/line_intervals.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

TEST(JoinedIntervals, ClosesGapsAndKeepsTheKindSeenMost) {
  const auto joined = joinedIntervals({{2.0, 3.0, LineKind::kConvex},
                                       {0.0, 1.9, LineKind::kConcave},
                                       {0.5, 1.0, LineKind::kConvex},
                                       {4.0, 5.0, LineKind::kUnknown}},
                                      0.2);
  ASSERT_EQ(joined.size(), 2U);
  EXPECT_EQ(joined[0].begin, 0.0);
  EXPECT_EQ(joined[0].end, 3.0);
  EXPECT_EQ(joined[0].kind, LineKind::kConcave);  // 1.9 m against 1.5 m
  EXPECT_EQ(joined[1].begin, 4.0);
  EXPECT_EQ(joined[1].kind, LineKind::kUnknown);
  EXPECT_TRUE(joinedIntervals({}, 1.0).empty());
}

TEST(JoinedIntervals, CoverWhatWasGivenAndStayApart) {
  test::Random random(1);
  for (int k = 0; k < 60; ++k) {
    std::vector<LineInterval> intervals;
    for (int i = random.integer(1, 20); i > 0; --i) {
      const double begin = random.uniform(-5.0, 5.0);
      intervals.push_back({begin, begin + random.uniform(0.0, 1.0), LineKind::kConcave});
    }
    const double max_gap = random.uniform(0.0, 0.5);
    const auto joined = joinedIntervals(intervals, max_gap);
    for (std::size_t i = 1; i < joined.size(); ++i) {
      EXPECT_GT(joined[i].begin, joined[i - 1].end + max_gap);
    }
    for (const LineInterval& given : intervals) {
      int covering = 0;
      for (const LineInterval& j : joined) covering += j.begin <= given.begin && given.end <= j.end;
      EXPECT_EQ(covering, 1);
    }
  }
}

}  // namespace
}  // namespace opp::mapping
