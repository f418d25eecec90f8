// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detect_primitives.h"

#include "opp/geometry/constants.h"

#include "support/degenerate_clouds.h"
#include "support/depth_image.h"
#include "support/random.h"
#include "support/synthetic_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace opp {
namespace {

TEST(DetectPrimitives, RoomFromInsideHasSixPlanesInOneExactFrame) {
  test::Random random(1);
  const test::SyntheticScene scene = test::sampleScene(
      test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5}), {0.3, 0.2, 1.2}, random.pose(1.0), {});
  StageTimings timings;
  const Primitives primitives = detectPrimitives(scene.cloud, PrimitiveParams{}, 1, &timings);
  ASSERT_EQ(primitives.planes.size(), 6U);
  EXPECT_EQ(primitives.edges.size(), 12U);
  ASSERT_EQ(primitives.families.size(), 3U);
  for (int k = 0; k < 3; ++k) {
    const auto a = static_cast<std::size_t>(k), b = static_cast<std::size_t>((k + 1) % 3);
    EXPECT_NEAR(primitives.families[a].normal.dot(primitives.families[b].normal), 0.0, 1e-12);
  }
  EXPECT_GT(timings.voting, 0.0);
  EXPECT_GT(timings.clustering, 0.0);
  EXPECT_GT(timings.refinement, 0.0);
}

TEST(DetectPrimitives, DetailShowsTheSidesOfASmallBox) {
  // A box of 8 × 10 × 6 cm on a floor, 1 m before a Kinect: sides of 300 pixels and more, which are
  // 2 to 6 samples of a room that fills the rest of the image.
  test::Random random(3);
  int found = 0;
  constexpr int kScans = 20;
  for (int scan = 0; scan < kScans; ++scan) {
    const Eigen::Isometry3d camera_from_box =
        Eigen::Translation3d(1.0, 0.0, -0.35) *
        Eigen::AngleAxisd(random.uniform(0.5, 1.0), Eigen::Vector3d::UnitZ());
    const Plane floor = Plane::fromPointNormal({0.0, 0.0, -0.35}, {0.0, 0.0, 1.0});
    const Plane wall = Plane::fromPointNormal({3.0, 0.0, 0.0}, {-1.0, 0.0, 0.0});
    std::vector<Plane> sides;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        const Eigen::Vector3d half(0.04, 0.05, 0.06);
        const Eigen::Vector3d normal = sign * Eigen::Vector3d::Unit(axis);
        sides.push_back(transformed(
            camera_from_box,
            Plane::fromPointNormal(normal.cwiseProduct(half) + Eigen::Vector3d(0, 0, 0), normal)));
      }
    }
    const test::RangeAlong room = test::insideOf({floor, wall}), box = test::outsideOf(sides);
    PointCloud cloud = test::renderDepth({}, [&](const Eigen::Vector3d& ray) {
      const double near = box(ray), far = room(ray);
      return std::isfinite(near) && near > 0.0 && near < far ? near : far;
    });
    const PrimitiveParams params;
    test::addRangeNoise(cloud, params.sensor, random);
    ScanSurface surface = makeScanSurface(cloud, params.sensor, params.sampling);
    const Primitives primitives = detectPrimitives(cloud, surface, params);
    ASSERT_EQ(primitives.labels.size(), surface.samples.size());
    for (const Plane& side : sides) {
      if (side.d() < 0.0) continue;  // on the far side
      found += std::any_of(primitives.planes.begin(), primitives.planes.end(), [&](const auto& p) {
        return angleBetween(p.plane, side) < degToRad(3.0) &&
               std::abs(p.plane.d() - side.d()) < 0.005;
      });
    }
  }
  EXPECT_GE(found, 3 * kScans * 9 / 10) << "of three sides each";
}

int planesLike(const Plane& wall, const Primitives& primitives) {
  return static_cast<int>(
      std::count_if(primitives.planes.begin(), primitives.planes.end(),
                    [&](const auto& p) { return angleBetween(p.plane, wall) < degToRad(10.0); }));
}

TEST(DetectPrimitives, DistortionDoesNotBreakAWall) {
  // Waves of two standard deviations of the distortion, 35° long, on a wall and a floor.
  test::Random random(5);
  const Plane wall = Plane::fromPointNormal({1.8, 0.0, 0.0}, {-1.0, 0.3, 0.1});
  const Plane floor = Plane::fromPointNormal({0.0, 0.0, -0.9}, {0.1, 0.0, 1.0});
  const test::RangeAlong room = test::insideOf({wall, floor});
  int broken = 0;
  for (int scan = 0; scan < 10; ++scan) {
    const Eigen::Vector3d wave = 2.0 * kPi / degToRad(35.0) * random.unitVector();
    const double phase = random.uniform(0.0, 2.0 * kPi);
    PrimitiveParams params;
    const SensorModel sensor = params.sensor;
    PointCloud cloud = test::renderDepth({}, [&](const Eigen::Vector3d& ray) {
      const double range = room(ray);
      return range + 2.0 * sensor.distortion(range) * std::sin(wave.dot(ray) + phase);
    });
    test::addRangeNoise(cloud, sensor, random);
    EXPECT_EQ(planesLike(wall, detectPrimitives(makeOrientedCloud(cloud, sensor, params.sampling),
                                                params)),
              1)
        << "scan " << scan;
    params.sensor.distortion_quadratic = 0.0;
    broken += planesLike(wall, detectPrimitives(makeOrientedCloud(cloud, sensor, params.sampling),
                                                params)) > 1;
  }
  EXPECT_GT(broken, 3) << "a sensor without distortion sees what is there";
}

TEST(DetectPrimitives, ABoardOnAWallIsAPlaneOfItsOwn) {
  // 8 mm are less than the distortion allows at 1.8 m; but at the board's rim the surface steps.
  test::Random random(6);
  const Plane wall = Plane::fromPointNormal({1.8, 0.0, 0.0}, {-1.0, 0.2, 0.1});
  const Plane board =
      Plane::fromPointNormal(Eigen::Vector3d(1.8, 0.0, 0.0) + 0.008 * wall.normal(), wall.normal());
  const Plane floor = Plane::fromPointNormal({0.0, 0.0, -0.9}, {0.1, 0.0, 1.0});
  const PrimitiveParams params;
  PrimitiveParams undistorted;
  undistorted.sensor.distortion_quadratic = 0.0;
  int found = 0;
  for (int scan = 0; scan < 30; ++scan) {
    const double left = random.uniform(-0.1, 0.3), low = random.uniform(-0.4, 0.0);
    PointCloud cloud = test::renderDepth({}, [&](const Eigen::Vector3d& ray) {
      const Eigen::Vector3d on_board = ray * test::insideOf({board})(ray);
      const bool hit = on_board.y() < left && on_board.y() > left - 0.6 && on_board.z() > low &&
                       on_board.z() < low + 0.5;
      return test::insideOf({hit ? board : wall, floor})(ray);
    });
    test::addRangeNoise(cloud, params.sensor, random);
    const OrientedCloud samples = makeOrientedCloud(cloud, params.sensor, params.sampling);
    const int planes = planesLike(wall, detectPrimitives(samples, params));
    found += planes > 1;
    EXPECT_EQ(planes > 1, planesLike(wall, detectPrimitives(samples, undistorted)) > 1)
        << "scan " << scan;
  }
  EXPECT_GE(found, 27);
}

TEST(DetectPrimitives, DegenerateCloudsGiveFinitePlanes) {
  for (const auto& [name, cloud] : test::degenerateClouds()) {
    SCOPED_TRACE(name);
    for (const PlanePrimitive& plane : detectPrimitives(cloud, PrimitiveParams{}).planes) {
      EXPECT_TRUE(plane.plane.coefficients().allFinite());
      EXPECT_TRUE(plane.covariance.allFinite());
    }
  }
}

}  // namespace
}  // namespace opp
