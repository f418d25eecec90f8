// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planar/landmark_covariance.h"

#include "support/random.h"
#include "support/sensors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

constexpr double kSigma = 0.001;

/// A wall x = 3 seen by `views` keyframes from anywhere 3 m before it: a patch `size` wide and high
/// around (3, 0, 0), of 400 samples.
MapState wallSeenBy(int views, double size, test::Random& random) {
  MapState map;
  map.landmarks.planes.push_back({Plane::fromCoefficients({-1, 0, 0}, 3.0), {}});
  for (int id = 0; id < views; ++id) {
    Keyframe keyframe;
    keyframe.map_from_body.linear() = random.rotation();
    keyframe.landmark_of_plane = {0};
    PlanePrimitive seen;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d point(3.0 + random.normal(kSigma),
                                  (i % 20 + 0.5) / 20.0 * size - 0.5 * size,
                                  (i / 20 + 0.5) / 20.0 * size - 0.5 * size);
      seen.moments.add(keyframe.map_from_body.inverse() * point, 1.0 / (kSigma * kSigma));
    }
    keyframe.features.primitives_in_body.planes.push_back(seen);
    map.keyframes.push_back(std::move(keyframe));
    map.landmarks.planes[0].observations.push_back({id, 0});
  }
  return map;
}

struct Deviation {
  double position, tilt;
};

Deviation deviationOf(const MapState& map, const SensorModel& sensor) {
  const PlaneLandmark& wall = map.landmarks.planes[0];
  const Eigen::Matrix3d covariance = landmarkCovariance(wall, map, sensor);
  return {positionDeviation({3.0, 0.0, 0.0}, wall.plane_in_map, covariance),
          std::sqrt(covariance(0, 0))};
}

TEST(LandmarkCovariance, IsThatOfTheNoiseWithoutDistortion) {
  test::Random random(1);
  const Deviation d = deviationOf(wallSeenBy(1, 0.3, random), test::sensorThatBends(0.0));
  EXPECT_NEAR(d.position, kSigma / 20.0, 1e-6);
  EXPECT_NEAR(d.tilt, kSigma / 20.0 / (0.3 / std::sqrt(12.0)), 1e-5);
}

TEST(LandmarkCovariance, DistortionIsOneErrorOfASmallPatch) {
  test::Random random(2);
  const Deviation d = deviationOf(wallSeenBy(1, 0.3, random), test::sensorThatBends(0.002));
  EXPECT_NEAR(d.position, 0.018, 0.001);
  EXPECT_NEAR(d.tilt, 0.06, 0.003);
}

TEST(LandmarkCovariance, OtherViewsAndWiderOnesKnowBetter) {
  test::Random random(3);
  const SensorModel sensor = test::sensorThatBends(0.002);
  const Deviation once = deviationOf(wallSeenBy(1, 0.3, random), sensor);
  const Deviation often = deviationOf(wallSeenBy(9, 0.3, random), sensor);
  const Deviation wide = deviationOf(wallSeenBy(1, 1.8, random), sensor);  // 6 × 6 such patches
  EXPECT_NEAR(often.position, once.position / 3.0, 1e-3);
  EXPECT_NEAR(often.tilt, once.tilt / 3.0, 3e-3);
  EXPECT_NEAR(wide.position, once.position / 6.0, 1e-3);
  EXPECT_NEAR(wide.tilt, 0.018 / 0.3 * std::sqrt(12.0 / std::pow(6.0, 3) / 6.0), 1e-3);
}

TEST(LandmarkCovariance, ASurfaceThatNobodySawIsUnknown) {
  MapState map;
  map.landmarks.planes.push_back({Plane::fromCoefficients({-1, 0, 0}, 3.0), {}});
  EXPECT_GE(deviationOf(map, test::sensorThatBends(0.002)).position, 1.0);
}

}  // namespace
}  // namespace opp::mapping
