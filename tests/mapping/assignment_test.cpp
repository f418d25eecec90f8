// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/assignment.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace opp::mapping {
namespace {

struct Total {
  int pairs = 0;
  double cost = 0.0;
};

/// Best total over all assignments, by trying them all.
Total bestByTrying(std::size_t left, std::size_t lefts, std::vector<bool>& taken,
                   const std::vector<AssignmentCandidate>& candidates) {
  if (left == lefts) return {};
  Total best = bestByTrying(left + 1, lefts, taken, candidates);
  for (const AssignmentCandidate& c : candidates) {
    if (c.left != left || taken[c.right]) continue;
    taken[c.right] = true;
    Total total = bestByTrying(left + 1, lefts, taken, candidates);
    taken[c.right] = false;
    ++total.pairs;
    total.cost += c.cost;
    if (total.pairs > best.pairs || (total.pairs == best.pairs && total.cost < best.cost)) {
      best = total;
    }
  }
  return best;
}

TEST(Assignment, PrefersMorePairsToACheaperOne) {
  // Greedy takes (0, 1) for 0.5 and leaves left 1 and right 0 alone.
  const std::vector<int> result = assignOneToOne(2, 2, {{0, 0, 1.0}, {0, 1, 0.5}, {1, 1, 1.0}});
  EXPECT_EQ(result, (std::vector<int>{0, 2}));
}

TEST(Assignment, TakesTheCheapestOfEqualNumbers) {
  const std::vector<int> result =
      assignOneToOne(2, 2, {{0, 0, 1.0}, {0, 1, 2.0}, {1, 0, 2.0}, {1, 1, 4.0}});
  EXPECT_EQ(result, (std::vector<int>{1, 2}));
}

TEST(Assignment, LeavesFreeWhatHasNoCandidate) {
  EXPECT_EQ(assignOneToOne(3, 1, {{1, 0, 0.0}}), (std::vector<int>{-1, 0, -1}));
  EXPECT_EQ(assignOneToOne(2, 2, {}), (std::vector<int>{-1, -1}));
  EXPECT_TRUE(assignOneToOne(0, 0, {}).empty());
}

TEST(Assignment, IsAsGoodAsTheBestOfAllForRandomCosts) {
  test::Random random(91);
  for (int k = 0; k < 200; ++k) {
    const auto lefts = static_cast<std::size_t>(random.integer(0, 5));
    const auto rights = static_cast<std::size_t>(random.integer(0, 5));
    std::vector<AssignmentCandidate> candidates;
    for (std::size_t l = 0; l < lefts; ++l) {
      for (std::size_t r = 0; r < rights; ++r) {
        if (random.integer(0, 1) == 1) candidates.push_back({l, r, random.uniform(0.0, 3.0)});
      }
    }
    std::vector<bool> taken(rights, false);
    const Total best = bestByTrying(0, lefts, taken, candidates);
    Total found;
    std::vector<std::size_t> used;
    const std::vector<int> result = assignOneToOne(lefts, rights, candidates);
    for (std::size_t l = 0; l < lefts; ++l) {
      if (result[l] < 0) continue;
      const AssignmentCandidate& c = candidates[static_cast<std::size_t>(result[l])];
      EXPECT_EQ(c.left, l);
      EXPECT_EQ(std::count(used.begin(), used.end(), c.right), 0);
      used.push_back(c.right);
      ++found.pairs;
      found.cost += c.cost;
    }
    EXPECT_EQ(found.pairs, best.pairs);
    EXPECT_NEAR(found.cost, best.cost, 1e-9);  // rounding of sums, kept below by the algorithm
  }
}

TEST(Assignment, RejectsIndicesAndCostsOutOfRange) {
  EXPECT_THROW(assignOneToOne(1, 1, {{1, 0, 0.0}}), std::invalid_argument);
  EXPECT_THROW(assignOneToOne(1, 1, {{0, 1, 0.0}}), std::invalid_argument);
  EXPECT_THROW(assignOneToOne(1, 1, {{0, 0, std::numeric_limits<double>::infinity()}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
