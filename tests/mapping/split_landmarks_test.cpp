// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/split_landmarks.h"

#include "support/random.h"
#include "support/sensors.h"

#include <gtest/gtest.h>

#include <vector>

namespace opp::mapping {
namespace {

constexpr double kSigma = 0.002;

/// A map with one landmark, the plane z = 0, of which keyframe k saw 1 m² at heights[k] from 3 m.
MapState mapOfOne(const std::vector<double>& heights, test::Random& random) {
  MapState map;
  map.landmarks.planes.push_back({Plane::fromCoefficients({0, 0, 1}, 0.0), {}});
  for (const double height : heights) {
    const int id = static_cast<int>(map.keyframes.size());
    Keyframe keyframe;
    keyframe.map_from_body =
        Eigen::Translation3d(0.0, 0.0, 3.0) * Eigen::Quaterniond(random.pose(1.0).linear());
    keyframe.landmark_of_plane = {0};
    PlaneFactor factor{id, 0, {}, 100.0};
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d point(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),
                                  height + random.normal(kSigma));
      factor.moments_in_body.add(keyframe.map_from_body.inverse() * point, 1.0 / (kSigma * kSigma));
    }
    map.keyframes.push_back(std::move(keyframe));
    map.factors.planes.push_back(factor);
    map.landmarks.planes[0].observations.push_back({id, 0});
  }
  return map;
}

using test::sensorThatBends;

TEST(SplitLandmarks, TwoTableTopsComeApart) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    MapState map = mapOfOne({0.0, 0.03, 0.0, 0.03, 0.0}, random);
    EXPECT_EQ(splitLandmarks(map, sensorThatBends(0.0), BackendParams()), 1) << "seed " << seed;
    ASSERT_EQ(map.landmarks.planes.size(), 2U);
    for (std::size_t k = 0; k < 5; ++k) {
      // Which of the two has most weight, and keeps the number, is up to the noise.
      const int other = map.factors.planes[0].landmark;
      const int expected = k % 2 == 0 ? other : 1 - other;
      EXPECT_EQ(map.factors.planes[k].landmark, expected);
      EXPECT_EQ(map.keyframes[k].landmark_of_plane, std::vector<int>{expected});
    }
    const auto low = static_cast<std::size_t>(map.factors.planes[0].landmark);
    EXPECT_EQ(map.landmarks.planes[low].observations.size(), 3U);
    EXPECT_EQ(map.landmarks.planes[1 - low].observations.size(), 2U);
    EXPECT_NEAR(map.landmarks.planes[low].plane_in_map.d(), 0.0, 0.001);
    EXPECT_NEAR(map.landmarks.planes[1 - low].plane_in_map.d(), -0.03, 0.001);
    EXPECT_EQ(splitLandmarks(map, sensorThatBends(0.0), BackendParams()), 0) << "once is enough";
  }
}

TEST(SplitLandmarks, NoiseTakesNothingApart) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    MapState map = mapOfOne({0.0, 0.002, -0.002, 0.0}, random);
    EXPECT_EQ(splitLandmarks(map, sensorThatBends(0.0), BackendParams()), 0) << "seed " << seed;
    EXPECT_EQ(map.landmarks.planes.size(), 1U);
  }
}

TEST(SplitLandmarks, DistortionThatTheMapShowsTakesNothingApart) {
  // 18 mm at 3 m, which all views show, none more than the others.
  test::Random random(1);
  MapState map = mapOfOne({0.018, -0.018, 0.015, -0.015, 0.02, -0.02}, random);
  EXPECT_EQ(splitLandmarks(map, sensorThatBends(0.002), BackendParams()), 0);
  EXPECT_GT(splitLandmarks(map, sensorThatBends(0.0), BackendParams()), 0);
}

TEST(SplitLandmarks, CornersAndRightAnglesAreThoseOfTheSets) {
  test::Random random(2);
  MapState map = mapOfOne({0.0, 0.0, 0.03}, random);
  const std::vector<Plane> walls = {Plane::fromCoefficients({1, 0, 0}, 1.0),
                                    Plane::fromCoefficients({0, 1, 0}, 1.0)};
  for (const Plane& wall : walls) map.landmarks.planes.push_back({wall, {}});
  for (Keyframe& keyframe : map.keyframes) {
    keyframe.landmark_of_plane = {0, 1, 2};
    Primitives& seen = keyframe.features.primitives_in_body;
    seen.planes.resize(3);
    seen.edges = {{{0, 1}, 1.0}, {{0, 2}, 1.0}};
    Corner corner;
    corner.planes = {0, 1, 2};
    seen.corners = {corner};
  }
  ASSERT_EQ(splitLandmarks(map, sensorThatBends(0.0), BackendParams()), 1);
  EXPECT_EQ(map.keyframes[2].landmark_of_plane, (std::vector<int>{3, 1, 2}));
  EXPECT_EQ(map.factors.orthogonalities.size(), 4U);
  ASSERT_EQ(map.landmarks.corners.size(), 2U);
  EXPECT_EQ(map.landmarks.corners[0].planes, (std::array<int, 3>{0, 1, 2}));
  EXPECT_EQ(map.landmarks.corners[0].observations.size(), 2U);
  EXPECT_EQ(map.landmarks.corners[1].planes, (std::array<int, 3>{1, 2, 3}));
}

TEST(SplitLandmarks, AnEmptyMapStaysEmpty) {
  MapState map;
  EXPECT_EQ(splitLandmarks(map, SensorModel(), BackendParams()), 0);
}

}  // namespace
}  // namespace opp::mapping
