// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/hand_path.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/simulation/scene.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <limits>

namespace opp::mapping {
namespace {

HandMotion steady() {
  HandMotion motion;
  motion.jitter_position = motion.jitter_angle = 0.0;
  return motion;
}

/// The longest step between neighbouring samples [m].
double motionBetweenSamples(const HandPath& path, int steps) {
  double longest = 0.0;
  for (int k = 0; k < steps; ++k) {
    const Eigen::Vector3d a = path.mapFromBody(path.duration() * k / steps).translation();
    const Eigen::Vector3d b = path.mapFromBody(path.duration() * (k + 1) / steps).translation();
    longest = std::max(longest, (b - a).norm());
  }
  return longest;
}

TEST(HandPath, StartsAndEndsAtItsWaypoints) {
  const std::vector<Waypoint> waypoints = {
      {{0, 0, 1.5}, 0.0, 0.1}, {{1, 0, 1.5}, 0.5, 0.2}, {{2, 1, 1.4}, 1.0, 0.0}};
  const HandPath path(waypoints, steady(), 1);
  EXPECT_TRUE(path.mapFromBody(0.0).translation().isApprox(waypoints[0].position, 1e-9));
  const Eigen::Isometry3d end = path.mapFromBody(path.duration());
  EXPECT_TRUE(end.translation().isApprox(waypoints[2].position, 1e-9));
  // Positive pitch looks down; yaw turns to the left.
  EXPECT_LT((path.mapFromBody(0.0) * Eigen::Vector3d::UnitX()).z(), 1.5);
  EXPECT_GT((end.linear() * Eigen::Vector3d::UnitX()).y(), 0.5);
  EXPECT_FALSE(path.closed());
}

TEST(HandPath, PassesThroughEachWaypointOfRandomPaths) {
  test::Random random(21);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Waypoint> waypoints;
    const int count = random.integer(2, 8);
    for (int k = 0; k < count; ++k) {
      waypoints.push_back({random.vector(3.0), random.uniform(-9, 9), random.uniform(-1, 1)});
    }
    const HandPath path(waypoints, steady(), 1);
    for (const Waypoint& waypoint : waypoints) {
      double least = std::numeric_limits<double>::infinity();
      const int steps = 1000;
      for (int k = 0; k <= steps; ++k) {
        const Eigen::Isometry3d pose = path.mapFromBody(path.duration() * k / steps);
        least = std::min(least, (pose.translation() - waypoint.position).norm());
      }
      // No sample is further from it than its neighbour.
      EXPECT_LT(least, motionBetweenSamples(path, steps));
    }
  }
}

TEST(HandPath, EachBuiltInSceneIsWalkedAtHumanSpeed) {
  for (const auto name : builtInScenes()) {
    SCOPED_TRACE(name);
    const Scene scene = loadScene(std::string(name));
    const HandPath path(scene.waypoints, scene.motion, 1);
    const double step = 0.02;  // [s]
    double fastest = 0.0, fastest_turn = 0.0, length = 0.0;
    for (double t = 0.0; t + step < path.duration(); t += step) {
      const Eigen::Isometry3d motion = path.mapFromBody(t).inverse() * path.mapFromBody(t + step);
      length += motion.translation().norm();
      fastest = std::max(fastest, motion.translation().norm() / step);
      fastest_turn = std::max(fastest_turn, Eigen::AngleAxisd(motion.linear()).angle() / step);
    }
    EXPECT_LT(fastest, 0.65);
    EXPECT_LT(fastest_turn, degToRad(40.0));
    EXPECT_GT(length, 3.0);
  }
}

TEST(HandPath, RepeatsAClosedWay) {
  const Scene scene = loadScene("room");
  const HandPath path(scene.waypoints, scene.motion, 1);
  EXPECT_TRUE(path.closed());
  HandMotion motion = steady();
  const HandPath without_unrest(scene.waypoints, motion, 1);
  const double t = 3.21;
  EXPECT_TRUE(without_unrest.mapFromBody(t).isApprox(
      without_unrest.mapFromBody(t + without_unrest.duration()), 1e-9));
}

TEST(HandPath, UnrestFollowsTheSeedAndStaysSmall) {
  const Scene scene = loadScene("room");
  const HandPath still(scene.waypoints, steady(), 1);
  const HandPath a(scene.waypoints, scene.motion, 1), b(scene.waypoints, scene.motion, 2);
  double difference = 0.0;
  for (double t = 0.0; t < 10.0; t += 0.1) {
    const double off = (a.mapFromBody(t).translation() - still.mapFromBody(t).translation()).norm();
    EXPECT_LE(off, std::sqrt(3.0) * scene.motion.jitter_position);
    difference += (a.mapFromBody(t).translation() - b.mapFromBody(t).translation()).norm();
  }
  EXPECT_GT(difference, 0.0);
}

TEST(HandPath, RefusesWaysThatLeadNowhere) {
  EXPECT_THROW(HandPath({}, {}, 1), std::invalid_argument);
  EXPECT_THROW(HandPath({Waypoint()}, {}, 1), std::invalid_argument);
  EXPECT_THROW(HandPath({Waypoint(), Waypoint(), Waypoint()}, {}, 1), std::invalid_argument);
  Waypoint bad;
  bad.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(HandPath({Waypoint(), bad}, {}, 1), std::invalid_argument);
  HandMotion motion;
  motion.speed = 0.0;
  EXPECT_THROW(HandPath({Waypoint(), {{1, 0, 0}, 0, 0}}, motion, 1), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
