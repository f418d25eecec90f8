// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/level_ties.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

constexpr double kLimit = 0.02;  // m²

/// Adds a keyframe that sees a floor and a larger wall, both new, in a frame that is `tilt` off.
void addKeyframe(const Eigen::Isometry3d& map_from_body, const Eigen::Matrix3d& tilt,
                 MapState& map) {
  Keyframe keyframe;
  keyframe.map_from_body = map_from_body;
  for (const auto& [normal, area] : {std::pair<Eigen::Vector3d, double>{{0.0, 0.0, 1.0}, 2.0},
                                     std::pair<Eigen::Vector3d, double>{{0.0, -1.0, 0.0}, 5.0}}) {
    PlanePrimitive plane;
    plane.area = area;
    keyframe.features.primitives_in_body.planes.push_back(plane);
    keyframe.landmark_of_plane.push_back(static_cast<int>(map.landmarks.planes.size()));
    map.landmarks.planes.push_back({Plane::fromCoefficients(tilt * normal, 1.0), {}});
  }
  map.keyframes.push_back(keyframe);
}

/// Two keyframes before a bare wall whose normal is y; the second is turned about it by `angle`.
/// The tie leaves that open by `open` [rad].
MapState pastAWall(double angle, double open, std::uint64_t seed) {
  test::Random random(seed);
  MapState map;
  const Eigen::Matrix3d tilt =
      Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  addKeyframe(random.motion(0.4, 2.0), Eigen::Matrix3d::Identity(), map);
  addKeyframe(Eigen::Isometry3d(tilt) * random.motion(0.4, 2.0), tilt, map);
  map.links.push_back({0, 1, 1.0});
  RelativePoseFactor tie{0, 1,
                         map.keyframes[0].map_from_body.inverse() * map.keyframes[1].map_from_body,
                         1e6 * Matrix6d::Identity(), false};
  const Eigen::Vector3d axis =
      map.keyframes[0].map_from_body.linear().transpose() * Eigen::Vector3d::UnitY();
  tie.information.topLeftCorner<3, 3>() += (1.0 / (open * open) - 1e6) * axis * axis.transpose();
  tie.information.bottomRightCorner<3, 3>() *= 1e-5;  // 0.3 m
  map.factors.relative_poses.push_back(tie);
  return map;
}

/// Angle between the ups of both keyframes as the tie has them.
double unevenness(const MapState& map) {
  const auto upIn = [&](std::size_t k) -> Eigen::Vector3d {
    const Keyframe& keyframe = map.keyframes[k];
    const int floor = keyframe.landmark_of_plane[0];
    return keyframe.map_from_body.linear().transpose() *
           map.landmarks.planes[static_cast<std::size_t>(floor)].plane_in_map.normal();
  };
  const Eigen::Vector3d up =
      map.factors.relative_poses.front().first_from_second.linear() * upIn(1);
  return std::acos(std::min(1.0, up.dot(upIn(0))));
}

TEST(LevelTies, LetsFloorsBeLevelBeyondABareWall) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    MapState map = pastAWall(0.15, 0.3, seed);
    EXPECT_NEAR(unevenness(map), 0.15, 1e-9);
    EXPECT_TRUE(levelTies(kLimit, MapperParams(), map));
    EXPECT_LT(unevenness(map), 0.002);
    const Matrix6d covariance = map.factors.relative_poses.front().information.inverse();
    // Two floors that are level within 1°.
    EXPECT_LT(std::sqrt(covariance.topLeftCorner<3, 3>().trace()), 0.026);
  }
}

TEST(LevelTies, BelievesATieThatDeniesIt) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    MapState map = pastAWall(0.15, 0.02, seed);
    const RelativePoseFactor before = map.factors.relative_poses.front();
    EXPECT_FALSE(levelTies(kLimit, MapperParams(), map));
    EXPECT_EQ(map.factors.relative_poses.front().information, before.information);
    EXPECT_NEAR(unevenness(map), 0.15, 1e-9);
  }
}

TEST(LevelTies, LeavesTiesWithinASetAlone) {
  MapState map = pastAWall(0.15, 0.3, 1);
  map.links.front().variance = 1e-4;
  EXPECT_FALSE(levelTies(kLimit, MapperParams(), map));
}

TEST(LevelTies, WantsSomethingLevelOnBothSides) {
  MapState map = pastAWall(0.15, 0.3, 1);
  map.landmarks.planes[2].plane_in_map = Plane::fromCoefficients(Eigen::Vector3d::UnitX(), 1.0);
  EXPECT_FALSE(levelTies(kLimit, MapperParams(), map));
}

}  // namespace
}  // namespace opp::mapping
