// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/lidar.h"

#include "opp/mapping/simulation/solids.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

World squareHall() {
  World world;
  addRoom(world, {{-4, -4}, {4, -4}, {4, 4}, {-4, 4}}, -1.5, 3.0);
  return world;
}

TEST(Lidar, RangeNoiseHasTheStatedDeviation) {
  LidarModel model;
  model.dropout = 0.0;
  const World world = squareHall();
  const LidarScan scan = sweep(RayTracer(world), Eigen::Isometry3d::Identity(), model, 3, 0);
  double squares = 0.0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3d point = scan.points[i].cast<double>();
    const Plane plane = world.sidePlane(scan.sides[i]);
    const Eigen::Vector3d ray = point.normalized();
    const double error = plane.signedDistance(point) / plane.normal().dot(ray);  // along the ray
    squares += error * error;
  }
  const auto count = static_cast<double>(scan.points.size());
  EXPECT_EQ(scan.points.size(), 16U * 1800U);
  // Four standard deviations of an estimate from 28,800 numbers: 4/√(2·28800) = 1.7 %.
  EXPECT_NEAR(std::sqrt(squares / count), model.noise, 0.017 * model.noise);
}

TEST(Lidar, RingsAndColumnsLieWhereTheModelSays) {
  LidarModel model = LidarModel::os1_64();
  model.noise = model.dropout = 0.0;
  const LidarScan scan = sweep(RayTracer(squareHall()), Eigen::Isometry3d::Identity(), model, 3, 0);
  ASSERT_EQ(scan.points.size(), 64U * 1024U);
  const Eigen::Vector3d first = scan.points.front().cast<double>();
  EXPECT_NEAR(std::atan2(first.z(), first.head<2>().norm()), model.lowest, 1e-6);  // float32
  EXPECT_NEAR(first.y(), 0.0, 1e-6);
  const Eigen::Vector3d last = scan.points.back().cast<double>();
  EXPECT_NEAR(std::atan2(last.z(), last.head<2>().norm()), model.highest, 1e-6);
}

TEST(Lidar, NothingAroundGivesNoReturns) {
  EXPECT_TRUE(sweep(RayTracer(World()), Eigen::Isometry3d::Identity(), {}, 1, 0).points.empty());
  LidarModel model;
  model.rings = 0;
  EXPECT_THROW(sweep(RayTracer(World()), Eigen::Isometry3d::Identity(), model, 1, 0),
               std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
