// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/labels_at_points.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace opp::mapping {
namespace {

using Points = std::vector<Eigen::Vector3f>;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(LabelsAtPoints, SameCloudsMatchByIndexEvenWherePointsCoincide) {
  const Points points{{0, 0, 0}, {0, 0, 0}, {kNan, 0, 0}, {1, 2, 3}};
  EXPECT_EQ(labelsAtPoints(points, points, {5, 6, 7, 8}), (std::vector<int>{5, 6, -1, 8}));
}

TEST(LabelsAtPoints, OtherOrdersMatchByPosition) {
  test::Random random(131);
  for (int k = 0; k < 50; ++k) {
    Points points;
    for (int i = 0; i < 40; ++i) points.push_back(random.vector(20.0).cast<float>());
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::reverse(order.begin(), order.end());
    Points shuffled;
    std::vector<int> labels;
    for (const std::size_t i : order) {
      // Rounding of a text file.
      shuffled.push_back(points[i] + random.vector(5e-5).cast<float>());
      labels.push_back(static_cast<int>(i));
    }
    const std::vector<int> found = labelsAtPoints(points, shuffled, labels);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(found[i], static_cast<int>(i));
  }
}

TEST(LabelsAtPoints, PointsThatAreNotThereHaveNoLabel) {
  const Points points{{0, 0, 0}, {1, 0, 0}, {kNan, 0, 0}};
  EXPECT_EQ(labelsAtPoints(points, {{1, 0, 0}}, {3}), (std::vector<int>{-1, 3, -1}));
  EXPECT_EQ(labelsAtPoints(points, {{1.0002F, 0, 0}}, {3}), (std::vector<int>{-1, -1, -1}));
  EXPECT_EQ(labelsAtPoints(points, {}, {}), (std::vector<int>{-1, -1, -1}));
  EXPECT_TRUE(labelsAtPoints({}, {}, {}).empty());
}

TEST(LabelsAtPoints, TakesTheNearestOfSeveral) {
  EXPECT_EQ(labelsAtPoints({{0, 0, 0}}, {{6e-5F, 0, 0}, {-2e-5F, 0, 0}}, {1, 2}),
            std::vector<int>{2});
}

TEST(LabelsAtPoints, NeedsALabelForEachPoint) {
  EXPECT_THROW(labelsAtPoints({}, {{0, 0, 0}}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
