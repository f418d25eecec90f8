// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/tied_sets.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

constexpr double kLimit = 0.04;  // m²

/// Keyframes in a row, tied well or, where `loose` is true for the later one, with nothing known.
MapState row(const std::vector<bool>& loose) {
  MapState map;
  for (std::size_t k = 0; k < loose.size(); ++k) {
    map.keyframes.emplace_back();
    map.keyframes.back().map_from_body.translation().x() = static_cast<double>(k);
    if (k == 0) continue;
    const int id = static_cast<int>(k);
    map.links.push_back({id - 1, id, loose[k] ? 1.0 : 1e-4});
  }
  return map;
}

TEST(TiedSets, AreNumberedInTheOrderOfTheirFirstKeyframes) {
  EXPECT_EQ(tiedSets(row({false, false, true, false, true}), kLimit),
            (std::vector<int>{0, 0, 1, 1, 2}));
  MapState map = row({false, true, true});
  map.links.push_back({0, 2, 1e-4});
  EXPECT_EQ(tiedSets(map, kLimit), (std::vector<int>{0, 1, 0}));
}

TEST(TiedSets, AreCutWhereTiesAreLooseAndNowhereElse) {
  test::Random random(1);
  for (int run = 0; run < 50; ++run) {
    std::vector<bool> loose(8);
    for (std::size_t k = 1; k < loose.size(); ++k) loose[k] = random.uniform(0.0, 1.0) < 0.3;
    const std::vector<int> sets = tiedSets(row(loose), kLimit);
    ASSERT_EQ(sets.size(), loose.size());
    for (std::size_t k = 1; k < loose.size(); ++k)
      EXPECT_EQ(sets[k], sets[k - 1] + (loose[k] ? 1 : 0)) << "run " << run;
  }
}

TEST(TiedSets, OfNoKeyframesAreNone) {
  EXPECT_TRUE(tiedSets(MapState(), kLimit).empty());
  EXPECT_EQ(tiedSets(row({false}), kLimit), std::vector<int>{0});
}

}  // namespace
}  // namespace opp::mapping
