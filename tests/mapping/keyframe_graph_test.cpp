// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/keyframe_graph.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp::mapping {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

MapState chain(int keyframes, double step_variance) {
  MapState map;
  for (int k = 0; k < keyframes; ++k) {
    map.keyframes.emplace_back();
    map.keyframes.back().map_from_body.translation().x() = k;
    if (k > 0) map.links.push_back({k - 1, k, step_variance});
  }
  return map;
}

TEST(ViewVariance, CountsTurnsAtTheDistanceOfTheView) {
  Keyframe keyframe;
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << 1e-4, 2e-4, 3e-4, 0.01, 0.04, 0.02;
  EXPECT_NEAR(viewVariance(covariance, keyframe), 0.04 + 3e-4, 1e-12) << "no nearer than 1 m";
  keyframe.view_centre_in_body = Eigen::Vector3d(0.0, 4.0, 3.0);
  EXPECT_NEAR(viewVariance(covariance, keyframe), 0.04 + 25.0 * 3e-4, 1e-12);
}

TEST(RelativeVariances, AddUpAlongAChain) {
  const std::vector<double> variances = relativeVariances(chain(5, 0.25), 1);
  EXPECT_EQ(variances, (std::vector<double>{0.25, 0.0, 0.25, 0.5, 0.75}));
}

TEST(RelativeVariances, TakeTheShortestWay) {
  MapState map = chain(5, 1.0);
  map.links.push_back({4, 0, 0.5});
  EXPECT_EQ(relativeVariances(map, 4), (std::vector<double>{0.5, 1.5, 2.0, 1.0, 0.0}));
}

TEST(RelativeVariances, AreInfiniteWhereNoLinkLeads) {
  MapState map = chain(2, 1.0);
  map.keyframes.emplace_back();
  EXPECT_EQ(relativeVariances(map, 0)[2], kInfinity);
}

TEST(RelativeVariances, ObeyTheTriangleInequalityOnRandomGraphs) {
  test::Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    MapState map = chain(12, random.uniform(0.1, 1.0));
    for (int k = 0; k < 10; ++k) {
      map.links.push_back({random.integer(0, 11), random.integer(0, 11), random.uniform(0.0, 3.0)});
    }
    const int a = random.integer(0, 11), b = random.integer(0, 11);
    const std::vector<double> from_a = relativeVariances(map, a),
                              from_b = relativeVariances(map, b);
    for (std::size_t k = 0; k < from_a.size(); ++k) {
      EXPECT_LE(from_a[k], from_a[static_cast<std::size_t>(b)] + from_b[k] + 1e-12);
    }
    EXPECT_NEAR(from_a[static_cast<std::size_t>(b)], from_b[static_cast<std::size_t>(a)], 1e-12);
  }
}

TEST(NearestViews, AreThoseOfTheKnownKeyframes) {
  const MapState map = chain(6, 1.0);
  const std::vector<double> variances = relativeVariances(map, 3);
  EXPECT_EQ(nearestViews(map, 3, variances, kInfinity, 3), (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(nearestViews(map, 3, variances, 1.5, 10), (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(nearestViews(map, 3, variances, 0.0, 10), (std::vector<int>{3}));
  EXPECT_TRUE(nearestViews(map, 3, variances, kInfinity, 0).empty());
}

}  // namespace
}  // namespace opp::mapping
