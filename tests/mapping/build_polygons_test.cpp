// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/build_polygons.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace opp::mapping {
namespace {

constexpr double kSpacing = 0.03;

/// Extent of the points of a jittered grid of [0, width] × [0, height] for which `holds` is true.
PlaneExtent extentOf(const PlaneFrame& frame, double width, double height, test::Random& random,
                     const std::function<bool(double, double)>& holds) {
  PlaneExtent extent(frame, PlanarParams().cell);
  for (double u = 0.5 * kSpacing; u < width; u += kSpacing) {
    for (double v = 0.5 * kSpacing; v < height; v += kSpacing) {
      const double jitter = 0.2 * kSpacing;
      const Eigen::Vector2d uv(u + random.uniform(-jitter, jitter),
                               v + random.uniform(-jitter, jitter));
      const Eigen::Vector3d off = random.normal(0.002) * frame.plane().normal();
      if (holds(uv.x(), uv.y())) extent.addSupport(frame.lift(uv) + off, kSpacing);
    }
  }
  return extent;
}

void expectWellFormed(const std::vector<PlanarPolygon>& polygons, const Plane& plane) {
  for (const PlanarPolygon& polygon : polygons) {
    EXPECT_GT(areaOf({{polygon.outer, {}}}, plane.normal()), 0.0) << "counter-clockwise";
    for (const auto& hole : polygon.holes) {
      EXPECT_LT(areaOf({{hole, {}}}, plane.normal()), 0.0) << "clockwise";
    }
    for (const Eigen::Vector3d& vertex : polygon.outer) {
      EXPECT_NEAR(plane.signedDistance(vertex), 0.0, 1e-12);
    }
  }
}

TEST(BuildPolygons, RectangleKeepsItsAreaAndCorners) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    const Plane plane = Plane::fromPointNormal(random.vector(3.0), random.unitVector());
    const PlaneFrame frame(plane, random.unitVector());
    const double width = random.uniform(0.5, 3.0), height = random.uniform(0.5, 3.0);
    const auto extent = extentOf(frame, width, height, random, [](double, double) { return true; });
    const auto polygons = buildPolygons(extent, PlanarParams());
    ASSERT_EQ(polygons.size(), 1U);
    EXPECT_TRUE(polygons[0].holes.empty());
    EXPECT_LT(polygons[0].outer.size(), 20U);
    expectWellFormed(polygons, plane);
    // Each side is off by at most a sample's spacing and the tolerance of the outline.
    const double tolerance = (width + height) * 2.0 * (kSpacing + 0.5 * 0.04);
    EXPECT_NEAR(areaOf(polygons, plane.normal()), width * height, tolerance);
    const Eigen::Vector3d center = frame.lift({0.5 * width, 0.5 * height});
    EXPECT_LT((centroidOf(polygons, plane.normal()) - center).norm(), 0.05);
  }
}

TEST(BuildPolygons, UnseenHoleIsClosedAndOpenHoleStays) {
  test::Random random(2);
  const PlaneFrame frame(Plane::fromPointNormal({0.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}),
                         Eigen::Vector3d::UnitY());
  const auto outside_door = [](double u, double v) {
    return !(u > 0.8 && u < 1.6 && v > 0.6 && v < 1.5);
  };
  PlaneExtent extent = extentOf(frame, 2.4, 2.4, random, outside_door);
  auto polygons = buildPolygons(extent, PlanarParams());
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_TRUE(polygons[0].holes.empty());

  const Eigen::Vector3d viewpoint = frame.lift({1.2, 1.0}) + 2.0 * frame.plane().normal();
  for (double u = 0.0; u < 2.4; u += kSpacing) {
    for (double v = 0.0; v < 2.4; v += kSpacing) {
      if (outside_door(u, v)) continue;
      const Eigen::Vector3d crossing = frame.lift({u, v});
      extent.addSightline(viewpoint, viewpoint + 2.0 * (crossing - viewpoint), 2.0 * kSpacing,
                          0.05);
    }
  }
  polygons = buildPolygons(extent, PlanarParams());
  ASSERT_EQ(polygons.size(), 1U);
  ASSERT_EQ(polygons[0].holes.size(), 1U);
  expectWellFormed(polygons, frame.plane());
  EXPECT_NEAR(areaOf(polygons, frame.plane().normal()), 2.4 * 2.4 - 0.8 * 0.9, 0.3);
}

TEST(BuildPolygons, ConcaveShapeStaysConcaveAndIslandsStayApart) {
  test::Random random(3);
  const PlaneFrame frame{Plane(), Eigen::Vector3d::UnitX()};
  const auto shape = [](double u, double v) {
    const bool corridor_bend = u < 1.0 || v < 1.0;
    const bool island = u > 2.0 && v > 2.0;
    return (corridor_bend && u < 3.0) || island;
  };
  const auto polygons = buildPolygons(extentOf(frame, 3.0, 3.0, random, shape), PlanarParams());
  ASSERT_EQ(polygons.size(), 2U);
  expectWellFormed(polygons, frame.plane());
  EXPECT_NEAR(areaOf({polygons[0]}, frame.plane().normal()), 5.0, 0.3);
  EXPECT_NEAR(areaOf({polygons[1]}, frame.plane().normal()), 1.0, 0.15);
}

TEST(BuildPolygons, DegenerateSupportHasNoPolygon) {
  const PlaneFrame frame{Plane(), Eigen::Vector3d::UnitX()};
  PlaneExtent extent(frame, 0.025);
  EXPECT_TRUE(buildPolygons(extent, PlanarParams()).empty());
  extent.addSupport({0.0, 0.0, 0.0}, kSpacing);
  extent.addSupport({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, kSpacing);
  EXPECT_TRUE(buildPolygons(extent, PlanarParams()).empty());
  PlaneExtent line(frame, 0.025);
  for (double u = 0.0; u < 0.5; u += 0.01) line.addSupport({u, 0.0, 0.0}, 0.01);
  EXPECT_TRUE(buildPolygons(line, PlanarParams()).empty());
  EXPECT_EQ(areaOf({}, Eigen::Vector3d::UnitZ()), 0.0);
  EXPECT_EQ(centroidOf({}, Eigen::Vector3d::UnitZ()), Eigen::Vector3d::Zero());
  EXPECT_THROW(PlaneExtent(frame, 0.0), std::invalid_argument);
}

TEST(PlaneExtent, OrderOfInsertionMakesNoDifference) {
  test::Random random(4);
  const PlaneFrame frame(Plane::fromPointNormal(random.vector(1.0), random.unitVector()),
                         Eigen::Vector3d::UnitX());
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < 20000; ++k) points.push_back(frame.lift(random.vector(1.0).head<2>()));
  PlaneExtent forward(frame, 0.02), backward(frame, 0.02);
  for (const auto& point : points) forward.addSupport(point, 0.05);
  std::for_each(points.rbegin(), points.rend(),
                [&](const auto& point) { backward.addSupport(point, 0.05); });
  EXPECT_TRUE(forward.supportCells() == backward.supportCells());
}

TEST(PlaneFrame, IsRightHandedAndLiftsOntoThePlane) {
  test::Random random(6);
  for (int k = 0; k < 100; ++k) {
    const Plane plane = Plane::fromPointNormal(random.vector(5.0), random.unitVector());
    const PlaneFrame frame(plane, k % 3 == 0 ? plane.normal() : random.unitVector());
    const Eigen::Vector2d uv(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0));
    EXPECT_LT((frame.project(frame.lift(uv)) - uv).norm(), 1e-12);
    EXPECT_NEAR(plane.signedDistance(frame.lift(uv)), 0.0, 1e-12);
    const Eigen::Vector3d u = frame.lift({1.0, 0.0}) - frame.lift({0.0, 0.0});
    const Eigen::Vector3d v = frame.lift({0.0, 1.0}) - frame.lift({0.0, 0.0});
    EXPECT_LT((u.cross(v) - plane.normal()).norm(), 1e-12);
    const Eigen::Vector2d centre = centreOf(frame.cellAt(frame.lift(uv), 0.1));
    EXPECT_LE((0.1 * centre - uv).cwiseAbs().maxCoeff(), 0.05 + 1e-12);
  }
}

}  // namespace
}  // namespace opp::mapping
