// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/merge_landmarks.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/frontend/insert_keyframe.h"

#include "support/random.h"
#include "support/sensors.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

constexpr double kSigma = 0.01;
constexpr double kGate = 4.0;

/// Adds a keyframe that saw one 1 m × 1 m patch of the plane z = height around (x, 0), as a
/// landmark of its own.
void addPatch(double x, double height, MapState& map, test::Random& random, double sigma = kSigma) {
  const int id = static_cast<int>(map.keyframes.size());
  Keyframe keyframe;
  keyframe.map_from_body = random.pose(2.0);
  keyframe.landmark_of_plane = {id};
  PlaneFactor factor;
  factor.keyframe = id;
  factor.landmark = id;
  factor.effective_samples = 100.0;
  const Eigen::Isometry3d body_from_map = keyframe.map_from_body.inverse();
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d point(x + random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),
                                height + random.normal(sigma));
    factor.moments_in_body.add(body_from_map * point, 1.0 / (sigma * sigma));
  }
  map.keyframes.push_back(std::move(keyframe));
  map.factors.planes.push_back(factor);
  map.landmarks.planes.push_back({Plane::fromCoefficients({0, 0, 1}, -height), {{id, 0}}});
}

TEST(MergeLandmarks, JoinsWhatIsOneSurfaceAndNothingElse) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    MapState map;
    addPatch(0.0, 0.0, map, random);
    addPatch(0.9, 0.005, map, random);  // the same, half a sigma off
    addPatch(0.0, 0.15, map, random);   // a table board 15 cm above
    addPatch(5.0, 0.0, map, random);    // coplanar, but far away
    EXPECT_EQ(mergeLandmarks(map, kGate), 1) << "seed " << seed;
    EXPECT_EQ(map.landmarks.planes[0].observations.size(), 2U);
    EXPECT_TRUE(map.landmarks.planes[1].observations.empty());
    EXPECT_EQ(map.keyframes[1].landmark_of_plane, std::vector<int>{0});
    EXPECT_EQ(map.factors.planes[1].landmark, 0);
    EXPECT_EQ(mergeLandmarks(map, kGate), 0) << "a second call finds nothing more";
  }
}

/// Adds what a keyframe 3 m away saw of the wall z = 0 around (x, 0): 1 m², tilted by `angle` about
/// y and moved by `height`, as a landmark of its own.
void addDistortedView(double x, double angle, double height, MapState& map, test::Random& random) {
  addPatch(0.0, 0.0, map, random);
  const Eigen::Isometry3d shown_from_flat =
      Eigen::Translation3d(x, 0.0, height) * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY());
  Keyframe& keyframe = map.keyframes.back();
  const Eigen::Isometry3d map_from_old = keyframe.map_from_body;
  keyframe.map_from_body =
      Eigen::Translation3d(0.0, 0.0, 3.0) * Eigen::Quaterniond(random.pose(1.0).linear());
  PointMoments& moments = map.factors.planes.back().moments_in_body;
  moments = transformed(keyframe.map_from_body.inverse() * shown_from_flat * map_from_old, moments);
  map.landmarks.planes.back().plane_in_map =
      transformed(shown_from_flat, map.landmarks.planes.back().plane_in_map);
}

/// 18 mm and 3.4° at 3 m.
SensorModel distortedSensor() { return test::sensorThatBends(0.002); }

TEST(UnifyPlanes, AWallBentAnotherWayFromEachViewIsOnePlane) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    MapState map;
    addDistortedView(0.0, 0.0, 0.0, map, random);
    addDistortedView(0.4, degToRad(7.5), 0.06, map, random);
    addDistortedView(0.0, 0.0, 0.25, map, random);  // a cupboard before the wall
    MapState undistorted = map;
    EXPECT_EQ(mergeLandmarks(undistorted, 3.0), 0) << "noise explains none of it, seed " << seed;
    EXPECT_EQ(unifyPlanes(map, distortedSensor(), BackendParams()), 1) << "seed " << seed;
    EXPECT_EQ(map.landmarks.planes[0].observations.size(), 2U);
    EXPECT_EQ(map.landmarks.planes[2].observations.size(), 1U);
    EXPECT_NEAR(map.landmarks.planes[0].plane_in_map.normal().z(), 1.0, 0.005);
  }
}

TEST(UnifyPlanes, ALayerSeenBesideItsWallStaysALayer) {
  test::Random random(3);
  MapState map;
  addDistortedView(0.0, 0.0, 0.0, map, random);
  addDistortedView(0.4, 0.0, 0.02, map, random);
  map.keyframes.front().landmark_of_plane.push_back(1);
  map.factors.planes.push_back(map.factors.planes.back());
  map.factors.planes.back().keyframe = 0;
  map.factors.planes.back().moments_in_body =
      transformed(map.keyframes[0].map_from_body.inverse() * map.keyframes[1].map_from_body,
                  map.factors.planes.back().moments_in_body);
  EXPECT_EQ(unifyPlanes(map, distortedSensor(), BackendParams()), 0);
}

TEST(UnifyPlanes, AMapThatShowsNoDistortionExcusesNothing) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Random random(seed);
    MapState map;
    addDistortedView(0.0, 0.0, 0.0, map, random);
    addDistortedView(0.9, 0.0, 0.06, map, random);  // a step of six standard deviations
    // A floor that five keyframes saw, each where the others did.
    for (int k = 0; k < 5; ++k) addPatch(20.0, 0.0, map, random);
    for (std::size_t k = 2; k < 7; ++k) map.factors.planes[k].landmark = 2;
    EXPECT_EQ(unifyPlanes(map, distortedSensor(), BackendParams()), 0) << "seed " << seed;
  }
}

TEST(UnifyPlanes, ASensorWithoutDistortionExcusesNothing) {
  test::Random random(4);
  MapState map;
  addDistortedView(0.0, 0.0, 0.0, map, random);
  addDistortedView(0.4, degToRad(6.0), 0.03, map, random);
  EXPECT_EQ(unifyPlanes(map, test::sensorThatBends(0.0), BackendParams()), 0);
}

TEST(UnifyPlanes, AWallBeyondADoorwayIsTheSamePlane) {
  constexpr double kFine = 0.001;
  int joined = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Random random(seed);
    MapState map;
    addPatch(0.0, 0.0, map, random, kFine);
    addPatch(3.0, 0.0, map, random, kFine);    // the same plane, 2 m of nothing between
    addPatch(-3.0, 0.01, map, random, kFine);  // a cupboard whose front is 1 cm off
    MapState growing = map;
    EXPECT_EQ(mergeLandmarks(growing, kGate), 0) << "parts that do not touch, seed " << seed;
    joined += unifyPlanes(map, distortedSensor(), BackendParams());
    EXPECT_EQ(map.landmarks.planes[2].observations.size(), 1U) << "seed " << seed;
  }
  EXPECT_GE(joined, 49) << "of 50; noise alone denies one in a thousand";
  EXPECT_LE(joined, 50);
}

TEST(UnifyPlanes, WhatIsKnownLooselyProvesNothing) {
  test::Random random(5);
  MapState map;
  addPatch(0.0, 0.0, map, random);
  addPatch(3.0, 0.0, map, random);  // 11 mm are uncertain over 3 m
  EXPECT_EQ(unifyPlanes(map, distortedSensor(), BackendParams()), 0);
}

TEST(MergeLandmarks, TheTwoSidesOfABoardStayTwo) {
  test::Random random(1);
  MapState map;
  addPatch(0.0, 0.0, map, random);
  addPatch(0.0, 0.005, map, random);
  map.landmarks.planes[1].plane_in_map = map.landmarks.planes[1].plane_in_map.flipped();
  EXPECT_EQ(mergeLandmarks(map, kGate), 0);
}

TEST(MergeLandmarks, WhatAKeyframeToldApartStaysTwo) {
  test::Random random(6);
  MapState map;
  addPatch(0.0, 0.0, map, random);
  addPatch(0.9, 0.005, map, random);
  MapState seen_together = map;
  seen_together.factors.planes[1].keyframe = 0;
  seen_together.factors.planes[1].moments_in_body =
      transformed(map.keyframes[0].map_from_body.inverse() * map.keyframes[1].map_from_body,
                  map.factors.planes[1].moments_in_body);
  EXPECT_EQ(mergeLandmarks(seen_together, kGate), 0);
  EXPECT_EQ(mergeLandmarks(map, kGate), 1) << "the same of two keyframes";
}

TEST(MergeLandmarks, RightAnglesAndCornersFollow) {
  test::Random random(2);
  MapState map;
  addPatch(0.0, 0.0, map, random);
  addPatch(0.9, 0.0, map, random);
  for (const Plane& wall :
       {Plane::fromCoefficients({1, 0, 0}, 1.0), Plane::fromCoefficients({0, 1, 0}, 1.0)})
    map.landmarks.planes.push_back({wall, {}});
  for (Keyframe& keyframe : map.keyframes) {
    keyframe.landmark_of_plane.insert(keyframe.landmark_of_plane.end(), {2, 3});
    Primitives& seen = keyframe.features.primitives_in_body;
    seen.planes.resize(3);
    seen.edges = {{{0, 1}, 1.0}};
    Corner corner;
    corner.planes = {0, 1, 2};
    seen.corners = {corner};
  }
  relink(map);
  ASSERT_EQ(map.factors.orthogonalities.size(), 2U);
  ASSERT_EQ(map.landmarks.corners.size(), 2U);
  ASSERT_EQ(mergeLandmarks(map, kGate), 1);
  ASSERT_EQ(map.factors.orthogonalities.size(), 1U);
  EXPECT_EQ(map.factors.orthogonalities[0].landmarks, (std::array<int, 2>{0, 2}));
  ASSERT_EQ(map.landmarks.corners.size(), 1U);
  EXPECT_EQ(map.landmarks.corners[0].planes, (std::array<int, 3>{0, 2, 3}));
  EXPECT_EQ(map.landmarks.corners[0].observations.size(), 2U);
}

TEST(MergeLandmarks, AnEmptyMapStaysEmpty) {
  MapState map;
  EXPECT_EQ(mergeLandmarks(map, kGate), 0);
}

}  // namespace
}  // namespace opp::mapping
