// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detection/neighbourhood_grid.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace opp {
namespace {

std::vector<Eigen::Vector3f> randomPoints(test::Random& random, int count, double half_extent) {
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < count; ++k) points.push_back(random.vector(half_extent).cast<float>());
  return points;
}

TEST(NeighbourhoodGrid, OrderHoldsEachPointOnce) {
  test::Random random(1);
  const NeighbourhoodGrid grid(randomPoints(random, 1000, 2.0), 0.5, 1);
  std::vector<std::uint32_t> order = grid.order();
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), 1000U);
  for (std::uint32_t i = 0; i < 1000; ++i) EXPECT_EQ(order[i], i);
}

TEST(NeighbourhoodGrid, CellsNearHoldAllPointsOfTheBallOnce) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    const auto points = randomPoints(random, 300, 2.0);
    const NeighbourhoodGrid grid(points, random.uniform(0.2, 1.0), seed);
    const Eigen::Vector3f center = random.vector(2.0).cast<float>();
    const double radius = random.uniform(0.1, 1.5);
    std::vector<NeighbourhoodGrid::Range> cells;
    grid.cellsNear(center, radius, cells);
    std::multiset<std::uint32_t> found;
    for (const auto& cell : cells) {
      for (std::uint32_t k = cell.begin; k < cell.end; ++k) found.insert(grid.order()[k]);
    }
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      EXPECT_LE(found.count(i), 1U);
      if ((points[i] - center).norm() < static_cast<float>(radius) - 1e-5F) {
        EXPECT_EQ(found.count(i), 1U);
      }
    }
  }
}

TEST(NeighbourhoodGrid, TakesEmptyAndCoincidentAndDistantPoints) {
  EXPECT_TRUE(NeighbourhoodGrid({}, 1.0, 1).order().empty());
  const Eigen::Vector3f far(1e30F, -1e30F, 1e30F);
  const NeighbourhoodGrid grid({far, far, Eigen::Vector3f::Zero()}, 1e-3, 1);
  std::vector<NeighbourhoodGrid::Range> cells;
  grid.cellsNear(Eigen::Vector3f::Zero(), 2e-3, cells);
  ASSERT_EQ(cells.size(), 1U);
  EXPECT_EQ(cells[0].size(), 1U);
}

}  // namespace
}  // namespace opp
