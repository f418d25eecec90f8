// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/surface_turn.h"

#include "geometry/planar_spread.h"
#include "geometry/visit_neighbours.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>
#include <vector>

namespace opp {
namespace {

TEST(PlanarSpread, OfAnEvenRectangleIsTheRectangle) {
  test::Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const double angle = random.uniform(0.0, 3.0);
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    const Eigen::Vector2d middle(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0));
    PlanarSpread spread;
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
      for (int k = 0; k < kSteps; ++k) {
        const Eigen::Vector2d x = middle + (3.0 * (i + 0.5) / kSteps - 1.5) * along +
                                  (1.0 * (k + 0.5) / kSteps - 0.5) * across;
        spread.add(x.x(), x.y());
      }
    }
    EXPECT_EQ(spread.count(), kSteps * kSteps);
    EXPECT_LT((spread.mean() - middle).norm(), 1e-9);
    EXPECT_LT((spread.widths() - Eigen::Vector2d(1.0, 3.0)).norm(), 1e-3);
    const PlanarSpread::Axes axes = spread.axes();
    EXPECT_LT((axes.widths - spread.widths()).norm(), 1e-9);
    EXPECT_NEAR(std::abs(axes.directions.col(1).dot(along)), 1.0, 1e-9);
  }
}

TEST(SurfaceTurn, OfACylinderIsItsArcAlongOneAxis) {
  test::Random random(2);
  const Eigen::Vector2d widths(0.1, 0.4);
  const double sigma = 1e-4;
  for (int trial = 0; trial < 20; ++trial) {
    const double radius = random.uniform(0.3, 2.0);
    SurfaceTurn surface(widths);
    for (int k = 0; k < 2000; ++k) {
      const Eigen::Vector2d place(random.uniform(-0.05, 0.05), random.uniform(-0.2, 0.2));
      const double height = place.x() * place.x() / (2.0 * radius) + 0.01 + 0.1 * place.y();
      surface.add(place, height + random.normal(sigma), sigma * sigma);
    }
    const SurfaceTurn::Turns turns = surface.turns();
    EXPECT_NEAR(turns.first.angle, widths[0] / radius, 5.0 * turns.first.error);
    EXPECT_LT(turns.second.angle, 5.0 * turns.second.error);
    EXPECT_GT(turns.first.error, 0.0);
    EXPECT_NEAR(surface.scatter(), 1.0, 0.2);  // χ² of 2000: ± 3 %
  }
}

TEST(SurfaceTurn, OfAFoldLeavesScatter) {
  test::Random random(3);
  const double sigma = 1e-3;
  SurfaceTurn surface({0.1, 0.1});
  for (int k = 0; k < 500; ++k) {
    const Eigen::Vector2d place(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05));
    surface.add(place, std::max(0.0, place.x()) + random.normal(sigma), sigma * sigma);
  }
  EXPECT_GT(surface.scatter(), 3.0);
}

TEST(SurfaceTurn, OfPlacesInALineIsNotKnown) {
  SurfaceTurn surface({0.1, 0.1});
  for (int k = 0; k < 50; ++k) surface.add({0.002 * k, 0.0}, 0.0, 1.0);
  EXPECT_FALSE(surface.turns().second.angle > 0.0);
  EXPECT_TRUE(std::isinf(SurfaceTurn({1.0, 1.0}).scatter()));
}

struct Cell {
  int row, col;
  bool operator<(const Cell& other) const {
    return row != other.row ? row < other.row : col < other.col;
  }
};

TEST(VisitNeighbours, FindsAllPairsThatTouchOnce) {
  test::Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    std::set<Cell> drawn;
    const int count = static_cast<int>(random.uniform(0.0, 80.0));
    for (int k = 0; k < count; ++k) {
      drawn.insert({static_cast<int>(random.uniform(-5.0, 5.0)),
                    static_cast<int>(random.uniform(-6.0, 6.0))});
    }
    const std::vector<Cell> cells(drawn.begin(), drawn.end());
    std::set<std::pair<std::size_t, std::size_t>> found, expected;
    std::size_t visits = 0;
    visitNeighbours(cells, [&](std::size_t i, std::size_t k) {
      found.emplace(i, k);
      ++visits;
    });
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (std::size_t k = i + 1; k < cells.size(); ++k) {
        if (std::abs(cells[i].row - cells[k].row) <= 1 &&
            std::abs(cells[i].col - cells[k].col) <= 1)
          expected.emplace(i, k);
      }
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(visits, expected.size());
  }
}

}  // namespace
}  // namespace opp
