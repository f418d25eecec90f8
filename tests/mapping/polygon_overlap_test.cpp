// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/polygon_overlap.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <limits>

namespace opp::mapping {
namespace {

/// Rectangle [x0, x1] × [y0, y1] in the plane z = 0 of a frame.
PlanarPolygon rectangle(double x0, double y0, double x1, double y1,
                        const Eigen::Isometry3d& map_from_plane = Eigen::Isometry3d::Identity()) {
  PlanarPolygon polygon;
  for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}) {
    polygon.outer.push_back(map_from_plane * Eigen::Vector3d(x, y, 0.0));
  }
  return polygon;
}

// The samples of kOverlapSamples cells can be off by the cells along the border of the shared area.
constexpr double kSampling = 0.05;

TEST(PolygonOverlap, AreaLeavesHolesOut) {
  PlanarPolygon frame = rectangle(0, 0, 3, 2);
  frame.holes.push_back(rectangle(1, 0.5, 2, 1).outer);
  EXPECT_NEAR(areaOf({frame}), 5.5, 1e-12);
  EXPECT_NEAR(areaOf({frame, rectangle(5, 5, 6, 6)}), 6.5, 1e-12);
  EXPECT_EQ(areaOf({}), 0.0);
  EXPECT_EQ(areaOf({PlanarPolygon{}}), 0.0);
}

TEST(PolygonOverlap, RectanglesShareTheirIntersectionInAnyFrame) {
  test::Random random(101);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d map_from_plane = random.pose(10.0);
    const Plane plane =
        transformed(map_from_plane, Plane::fromCoefficients(Eigen::Vector3d::UnitZ(), 0.0));
    const double x = random.uniform(0.0, 4.0);
    const double y = random.uniform(0.0, 2.0);
    const std::vector<PlanarPolygon> a{rectangle(0, 0, 4, 2, map_from_plane)};
    const std::vector<PlanarPolygon> b{rectangle(x, y, x + 4, y + 2, map_from_plane)};
    EXPECT_NEAR(sharedArea(plane, a, b), (4 - x) * (2 - y), kSampling * 8);
    EXPECT_NEAR(sharedArea(plane, a, a), 8.0, 1e-9);
  }
}

TEST(PolygonOverlap, HolesAreNotShared) {
  PlanarPolygon frame = rectangle(0, 0, 4, 4);
  frame.holes.push_back(rectangle(1, 1, 3, 3).outer);
  EXPECT_EQ(sharedArea(Plane(), {frame}, {rectangle(1.1, 1.1, 2.9, 2.9)}), 0.0);
  EXPECT_NEAR(sharedArea(Plane(), {frame}, {rectangle(0, 0, 4, 4)}), 12.0, kSampling * 12);
}

TEST(PolygonOverlap, NarrowSlantedPolygonsAreSampledEnough) {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const std::vector<PlanarPolygon> strip{rectangle(0, 0, 5, 0.02, turn)};
  EXPECT_NEAR(sharedArea(Plane(), strip, {rectangle(-10, -10, 10, 10)}), 0.1, kSampling * 0.1);
}

TEST(PolygonOverlap, SeveralPolygonsCountTogether) {
  const std::vector<PlanarPolygon> two{rectangle(0, 0, 1, 1), rectangle(3, 0, 4, 1)};
  EXPECT_NEAR(sharedArea(Plane(), two, {rectangle(0.5, 0, 3.5, 1)}), 1.0, kSampling * 2);
}

TEST(PolygonOverlap, DistanceIsMeasuredInThePlaneFromTheNearestPolygon) {
  test::Random random(102);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d map_from_plane = random.pose(10.0);
    const Plane plane =
        transformed(map_from_plane, Plane::fromCoefficients(Eigen::Vector3d::UnitZ(), 0.0));
    std::vector<PlanarPolygon> two{rectangle(0, 0, 2, 2, map_from_plane),
                                   rectangle(5, 0, 6, 1, map_from_plane)};
    two[0].holes = {rectangle(0.5, 0.5, 1.5, 1.5, map_from_plane).outer};
    const auto distance = [&](double x, double y, double z) {
      return distanceTo(plane, two, map_from_plane * Eigen::Vector3d(x, y, z));
    };
    EXPECT_EQ(distance(1.9, 1.9, 3.0), 0.0);
    EXPECT_EQ(distance(1.0, 1.0, 0.0), 0.0);  // in the hole
    EXPECT_NEAR(distance(2.5, 1.0, -1.0), 0.5, 1e-9);
    EXPECT_NEAR(distance(4.6, 0.5, 0.0), 0.4, 1e-9);
    EXPECT_NEAR(distance(-3.0, -4.0, 0.0), 5.0, 1e-9);
  }
  EXPECT_EQ(distanceTo(Plane(), {}, {0, 0, 0}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(distanceTo(Plane(), {rectangle(0, 0, 0, 0)}, {3, 4, 9}), 5.0);
}

TEST(PolygonOverlap, DegeneratePolygonsShareNothing) {
  const std::vector<PlanarPolygon> square{rectangle(0, 0, 1, 1)};
  EXPECT_EQ(sharedArea(Plane(), {}, square), 0.0);
  EXPECT_EQ(sharedArea(Plane(), square, {}), 0.0);
  EXPECT_EQ(sharedArea(Plane(), {rectangle(0, 0, 1, 0)}, square), 0.0);
  EXPECT_EQ(sharedArea(Plane(), {rectangle(2, 2, 2, 2)}, square), 0.0);
  EXPECT_EQ(sharedArea(Plane(), {PlanarPolygon{}}, square), 0.0);
}

}  // namespace
}  // namespace opp::mapping
