// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/primitives/label_points.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <limits>

namespace opp {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using test::Random;

/// Samples of the square [0, 1]² of the plane that `to_scene` makes of z = 0, all with one label.
void addSquare(const Eigen::Isometry3d& to_scene, int label, OrientedCloud& samples,
               Primitives& primitives) {
  constexpr int kSteps = 20;
  samples.spacing = 1.0 / kSteps;
  PlanePrimitive plane;
  plane.plane = Plane::fromPointNormal(to_scene.translation(), to_scene.linear().col(2));
  primitives.planes.push_back(plane);
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const Vector3d local((i % kSteps + 0.5) / kSteps, (i / kSteps + 0.5) / kSteps, 0.0);
    samples.points.push_back((to_scene * local).cast<float>());
    samples.normals.push_back(plane.plane.normal().cast<float>());
    samples.sigmas.push_back(0.001F);
    samples.weights.push_back(1.0F);
    primitives.labels.push_back(label);
  }
}

PrimitiveParams openParams() {
  PrimitiveParams params;
  params.sensor.noise_constant = 1e-4;
  params.sensor.noise_quadratic = 0.0;
  params.sensor.min_range = 0.0;
  params.sensor.max_range = 1000.0;
  return params;
}

TEST(LabelPoints, PointsOfTwoWallsGetTheWallTheyLieOn) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Isometry3d floor = random.pose(3.0);
    Eigen::Isometry3d wall = floor;
    wall.rotate(Eigen::AngleAxisd(kPi / 2, Vector3d::UnitX()));  // meets the floor at its x axis
    OrientedCloud samples;
    Primitives primitives;
    addSquare(floor, 0, samples, primitives);
    addSquare(wall, 1, samples, primitives);
    PointCloud cloud;
    std::vector<int> expected;
    for (int i = 0; i < 200; ++i) {
      // Farther from the edge than noise and flatness allow for.
      const Vector3d local(random.uniform(0.0, 1.0), random.uniform(0.02, 1.0), 0.0);
      cloud.points.push_back(((i % 2 == 0 ? floor : wall) * local).cast<float>());
      expected.push_back(i % 2);
    }
    EXPECT_EQ(labelPoints(cloud, samples, primitives, openParams()), expected);
  }
}

TEST(LabelPoints, PointsOffThePlaneFarFromItsSamplesOrWithoutMeasurementHaveNone) {
  OrientedCloud samples;
  Primitives primitives;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector3d(0, 0, 2);
  addSquare(pose, 0, samples, primitives);
  PointCloud cloud;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  cloud.points = {{0.5F, 0.5F, 2.0F}, {0.5F, 0.5F, 2.03F}, {3.0F, 0.5F, 2.0F}, {nan, 0.5F, 2.0F}};
  EXPECT_EQ(labelPoints(cloud, samples, primitives, openParams()),
            (std::vector<int>{0, -1, -1, -1}));
}

TEST(LabelPoints, NothingFoundLeavesEveryPointWithoutPlane) {
  PointCloud cloud;
  cloud.points.assign(3, Vector3f(1, 2, 3));
  EXPECT_EQ(labelPoints(cloud, {}, {}, openParams()), std::vector<int>(3, -1));
  Primitives primitives;
  primitives.labels = {0};
  EXPECT_THROW(labelPoints(cloud, {}, primitives, openParams()), std::invalid_argument);
}

}  // namespace
}  // namespace opp
