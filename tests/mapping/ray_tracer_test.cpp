// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/ray_tracer.h"

#include "opp/mapping/simulation/scene.h"
#include "opp/mapping/simulation/solids.h"

#include "support/first_hit.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

TEST(RayTracer, HitsTheNearSideOfABox) {
  World world;
  addBox(world, Eigen::Isometry3d::Identity(), {1, 1, 1});
  const RayTracer tracer(world);
  const RayHit hit = tracer.trace({3, 0.1, 0.2}, {-2, 0, 0});
  ASSERT_TRUE(hit.valid());
  EXPECT_DOUBLE_EQ(hit.distance, 1.25);
  EXPECT_TRUE(tracer.sideNormal(hit.side).isApprox(Eigen::Vector3d::UnitX(), 1e-15));
  EXPECT_FALSE(tracer.trace({3, 0.1, 0.2}, {2, 0, 0}).valid());
}

TEST(RayTracer, TellsTheSidesOfAFaceApart) {
  World world;
  world.addFace({{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}});
  const RayTracer tracer(world);
  EXPECT_EQ(tracer.trace({1, 0.2, 0.3}, {-1, 0, 0}).side, 0);
  EXPECT_EQ(tracer.trace({-1, 0.2, 0.3}, {1, 0, 0}).side, 1);
  EXPECT_TRUE(tracer.sideNormal(1).isApprox(-Eigen::Vector3d::UnitX(), 1e-15));
}

TEST(RayTracer, SeesThroughDoorsAndHoles) {
  World world;
  Wall wall;
  wall.end = {4, 0};
  wall.openings = {{1.0, 1.0, 0.0, 2.0, false}, {2.5, 1.0, 1.0, 1.0, false}};
  addWall(world, wall);
  const RayTracer tracer(world);
  EXPECT_FALSE(tracer.trace({1.5, -2, 1.0}, {0, 1, 0}).valid());
  EXPECT_TRUE(tracer.trace({1.5, -2, 2.2}, {0, 1, 0}).valid());
  EXPECT_FALSE(tracer.trace({3.0, -2, 1.5}, {0, 1, 0}).valid());
  EXPECT_TRUE(tracer.trace({3.0, -2, 0.5}, {0, 1, 0}).valid());
}

TEST(RayTracer, AgreesWithAskingEveryFaceInEachBuiltInScene) {
  for (const auto name : builtInScenes()) {
    SCOPED_TRACE(name);
    const Scene scene = loadScene(std::string(name));
    const RayTracer tracer(scene.world);
    test::Random random(5);
    int compared = 0;
    for (int trial = 0; trial < 300; ++trial) {
      const auto& waypoints = scene.waypoints;
      const auto i = static_cast<std::size_t>(random.integer(0, int(waypoints.size()) - 1));
      const Eigen::Vector3d origin = waypoints[i].position;
      const Eigen::Vector3d direction = random.unitVector();
      double nearest_edge = 0.0;
      const double truth = test::firstHit(scene.world, origin, direction, nearest_edge);
      if (nearest_edge < 1e-4) continue;  // 100 times float32 rounding at 10 m
      ++compared;
      const RayHit hit = tracer.trace(origin, direction);
      ASSERT_EQ(hit.valid(), std::isfinite(truth));
      if (!hit.valid()) continue;
      EXPECT_NEAR(hit.distance, truth, 1e-12 * truth);
    }
    EXPECT_GT(compared, 250);
  }
}

TEST(RayTracer, ListsGiveTheSameAsSingleRaysWhateverTheirLength) {
  const Scene scene = loadScene("room");
  const RayTracer tracer(scene.world);
  test::Random random(6);
  const Eigen::Vector3d origin(2.5, 2.0, 1.4);
  for (const std::size_t count : {0U, 1U, 15U, 16U, 17U, 100U}) {
    std::vector<Eigen::Vector3d> directions;
    for (std::size_t i = 0; i < count; ++i) directions.push_back(random.unitVector());
    const auto hits = tracer.trace(origin, directions);
    ASSERT_EQ(hits.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(hits[i].side, tracer.trace(origin, directions[i]).side);
    }
  }
}

TEST(RayTracer, BlockedMeansSomethingStandsBetween) {
  World world;
  addBox(world, Eigen::Isometry3d::Identity(), {1, 1, 1});
  const RayTracer tracer(world);
  const auto blocked = tracer.blocked({3, 0.1, 0.5}, {{-3, 0.1, 0.5}, {0.5, 0.1, 0.5}, {3, 5, 5}});
  EXPECT_TRUE(blocked[0]);
  EXPECT_FALSE(blocked[1]);  // the point lies on the box itself
  EXPECT_FALSE(blocked[2]);
}

TEST(RayTracer, AnEmptyWorldIsNeverHit) {
  const RayTracer tracer{World()};
  EXPECT_FALSE(tracer.trace({0, 0, 0}, {1, 0, 0}).valid());
  EXPECT_FALSE(tracer.blocked({0, 0, 0}, {{1, 0, 0}})[0]);
}

}  // namespace
}  // namespace opp::mapping
