// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/strip_patches.h"

#include "opp/cloud/oriented_cloud.h"

#include "support/depth_image.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp {
namespace {

using Eigen::Vector3d;
using test::Random;

constexpr double kPixel = 1.0 / 525.0;  // [rad] of a Kinect
constexpr int kCellPoints = 4;

PointNoise kinectNoise() { return {SensorModel{}, SamplingParams{}, kPixel}; }

/// Cells of 2 × 2 pixels of a plane, `rows` below each other and `cols` side by side amid the image
/// of a camera that looks along x, with noise along their rays.
OpenCells cellsOn(const Plane& plane, int rows, int cols, Random& random) {
  OpenCells cells;
  cells.rows = rows, cells.cols = cols;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const Vector3d ray =
          Vector3d(1.0, kPixel * (cols - 1 - 2 * col), kPixel * (rows - 1 - 2 * row)).normalized();
      OpenCell cell;
      const double range = -plane.d() / plane.normal().dot(ray);
      const double sigma = SensorModel{}.sigma(range) / std::sqrt(kCellPoints);
      cell.point = (range + random.normal(sigma)) * ray;
      cell.squared_range = cell.point.squaredNorm();
      cell.count = kCellPoints;
      cell.row = row, cell.col = col;
      cell.block = row / 2 * cols + col / 2;
      cells.at.push_back(static_cast<int>(cells.cells.size()));
      cells.cells.push_back(cell);
    }
  }
  return cells;
}

/// A unit vector at this angle from the axis of view [rad].
Vector3d tilted(double angle, Random& random) {
  const double azimuth = random.uniform(-kPi, kPi);
  return {-std::cos(angle), std::sin(angle) * std::cos(azimuth),
          std::sin(angle) * std::sin(azimuth)};
}

double pointsIn(const std::vector<StripPatch>& strips) {
  double points = 0.0;
  for (const StripPatch& strip : strips) points += strip.count;
  return points;
}

std::vector<StripPatch> find(const OpenCells& cells, const std::vector<Vector3d>& directions) {
  return findStrips(cells, directions, SamplingParams{}, kinectNoise(), kPixel);
}

TEST(FindStrips, FindsABoardSixPixelsWide) {
  Random random(1);
  const Plane front = Plane::fromPointNormal({2.0, 0.0, 0.0}, {-1.0, 0.0, 0.0});
  const auto strips = find(cellsOn(front, 60, 3, random), {Vector3d::UnitX(), Vector3d::UnitY()});
  // 2.5 standard deviations leave out 1.2 %.
  EXPECT_GT(pointsIn(strips), 0.9 * 60 * 3 * kCellPoints);
  for (const StripPatch& strip : strips) {
    EXPECT_EQ(strip.normal, Vector3d(-1.0, 0.0, 0.0)) << "towards the viewpoint";
    // Noise of four pixels and the lateral one, at a range of 2 m.
    EXPECT_NEAR(strip.point.x(), 2.0, 4.0 * SensorModel{}.sigma(2.0) / 2.0);
    EXPECT_NEAR(strip.sigma, SensorModel{}.sigma(2.0), 1e-4);
  }
}

TEST(FindStrips, FindsStripsOfKnownDirections) {
  Random random(2);
  int found = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const Vector3d normal = tilted(degToRad(random.uniform(0.0, 60.0)), random);
    const Plane plane = Plane::fromPointNormal({random.uniform(0.8, 2.0), 0.0, 0.0}, normal);
    const auto strips = find(cellsOn(plane, 80, 3, random), {normal, normal.unitOrthogonal()});
    found += pointsIn(strips) > 0.5 * 80 * 3 * kCellPoints ? 1 : 0;
    for (const StripPatch& strip : strips) EXPECT_GT(strip.normal.dot(normal), 0.999);
  }
  EXPECT_GE(found, 45);
}

TEST(FindStrips, TakesNoSliceOfAnotherSurface) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Vector3d normal = tilted(degToRad(random.uniform(0.0, 40.0)), random);
    const Plane plane = Plane::fromPointNormal({random.uniform(0.8, 2.0), 0.0, 0.0}, normal);
    const Vector3d side = normal.cross(random.unitVector()).normalized();
    const double turn = degToRad(random.uniform(30.0, 90.0));
    const Vector3d other = std::cos(turn) * normal + std::sin(turn) * side;
    EXPECT_TRUE(find(cellsOn(plane, 60, 40, random), {other}).empty()) << "trial " << trial;
  }
}

TEST(FindStrips, FindsNothingInNothing) {
  EXPECT_TRUE(find({}, {Vector3d::UnitX()}).empty());
  Random random(4);
  const Plane front = Plane::fromPointNormal({2.0, 0.0, 0.0}, {-1.0, 0.0, 0.0});
  EXPECT_TRUE(find(cellsOn(front, 60, 3, random), {}).empty());
  EXPECT_TRUE(find(cellsOn(front, 12, 3, random), {Vector3d::UnitX()}).empty()) << "144 points";
  EXPECT_TRUE(find(cellsOn(front, 200, 1, random), {Vector3d::UnitX()}).empty()) << "a line";
}

/// Points of patches that lie on the plane and have its normal.
double pointsOn(const OrientedCloud& patches, const Plane& plane) {
  double points = 0.0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const double offset = std::abs(plane.signedDistance(patches.points[i].cast<double>()));
    const double cosine = plane.normal().dot(patches.normals[i].cast<double>());
    if (offset < 0.01 && cosine > std::cos(degToRad(5.0))) {
      points += static_cast<double>(patches.weights[i]);
    }
  }
  return points;
}

TEST(ScanSurface, ShowsTheEdgeOfABoardBeforeAWall) {
  // A board of 25 mm, 9 pixels, stands out from a wall; its front is as narrow as that.
  Random random(6);
  int found = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(random.uniform(0.5, 0.7), Vector3d::UnitZ()).toRotationMatrix();
    const auto planeAt = [&](const Vector3d& point, const Vector3d& normal) {
      return Plane::fromPointNormal(Vector3d(1.5, 0.0, 0.0) + turn * point, turn * normal);
    };
    const Plane front = planeAt({0.0, 0.0, 0.0}, {-1.0, 0.0, 0.0});
    const test::RangeAlong board =
        test::outsideOf({front, planeAt({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}),
                         planeAt({0.0, -0.025, 0.0}, {0.0, -1.0, 0.0})});
    const test::RangeAlong wall = test::insideOf({planeAt({0.3, 0.0, 0.0}, {-1.0, 0.0, 0.0})});
    PointCloud cloud = test::renderDepth({}, [&](const Vector3d& ray) {
      const double near = board(ray), far = wall(ray);
      return near < far ? near : far;
    });
    test::addRangeNoise(cloud, SensorModel{}, random);
    const ScanSurface surface = makeScanSurface(cloud, SensorModel{}, SamplingParams{});
    found += pointsOn(surface.patches, front) > 1000.0 ? 1 : 0;  // a third of 480 × 7 pixels
  }
  EXPECT_GE(found, 9);
}

}  // namespace
}  // namespace opp
