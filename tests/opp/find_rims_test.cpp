// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/cloud/find_rims.h"

#include "opp/geometry/constants.h"

#include "support/depth_image.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace opp {
namespace {

using Eigen::Vector3d;
using test::Random;

constexpr double kPixel = 1.0 / 525.0;  // [rad] of a Kinect
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// A board of 2·half_width × 2·half_height in its own y and z, that faces −x.
struct Board {
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  double half_width = 0.5;
  double half_height = 0.4;

  Vector3d inBoard(const Vector3d& in_camera) const {
    return camera_from_board.inverse() * in_camera;
  }
  double range(const Vector3d& ray) const {
    const Vector3d normal = camera_from_board.linear().col(0);
    const double range = normal.dot(camera_from_board.translation()) / normal.dot(ray);
    const Vector3d hit = inBoard(range * ray);
    const bool inside = std::abs(hit.y()) <= half_width && std::abs(hit.z()) <= half_height;
    return range > 0.0 && inside ? range : kNothing;
  }
};

Board boardAt(double distance) {
  Board board;
  board.camera_from_board.translation() = Vector3d(distance, 0.0, 0.0);
  return board;
}

/// Range of a wall that the camera looks at.
double wallRange(const Vector3d& ray, double distance) { return distance / ray.x(); }

PointCloud boardBeforeWall(const Board& board, double wall) {
  return test::renderDepth({}, [&](const Vector3d& ray) {
    const double range = board.range(ray);
    return std::isnan(range) ? wallRange(ray, wall) : range;
  });
}

/// A wall with a hole of the board's shape, through which nothing is seen or, `behind` ≥ 0 farther,
/// another wall.
PointCloud hole(const Board& board, double behind) {
  return test::renderDepth({}, [&](const Vector3d& ray) {
    const double wall = board.camera_from_board.translation().x();
    return wallRange(ray, std::isnan(board.range(ray)) ? wall : wall + behind);
  });
}

/// Each rim lies on one of the board's edges and points across it; how many on each of the four.
Eigen::Array4i expectOnEdges(const Rims& rims, const Board& board, double outward,
                             double pixels_off) {
  Eigen::Array4i counts = Eigen::Array4i::Zero();
  for (std::size_t i = 0; i < rims.size(); ++i) {
    const Vector3d point = board.inBoard(rims.points[i].cast<double>());
    const Vector3d normal =
        outward * (board.camera_from_board.linear().transpose() * rims.normals[i].cast<double>());
    const bool upright = std::abs(normal.y()) > std::abs(normal.z());
    const double across = upright ? std::copysign(board.half_width, normal.y()) - point.y()
                                  : std::copysign(board.half_height, normal.z()) - point.z();
    const double pixel = kPixel * rims.points[i].cast<double>().norm();
    EXPECT_LT(std::abs(across), pixels_off * pixel) << point.transpose();
    EXPECT_NEAR(rims.normals[i].norm(), 1.0, 1e-5);
    EXPECT_NEAR(rims.normals[i].dot(rims.points[i]), 0.0, 1e-3);  // across the ray
    ++counts[(upright ? 0 : 2) + ((upright ? normal.y() : normal.z()) > 0.0 ? 0 : 1)];
  }
  return counts;
}

TEST(FindRims, BoardBeforeAWallEndsOnFourSides) {
  const Board board = boardAt(2.0);
  const Rims rims = findRims(boardBeforeWall(board, 3.0), SensorModel(), RimParams());
  const Eigen::Array4i counts = expectOnEdges(rims, board, 1.0, 1.5);
  // 262 × 210 pixels in squares of 16.
  for (const int k : {0, 1}) EXPECT_NEAR(counts[k], 13, 2);
  for (const int k : {2, 3}) EXPECT_NEAR(counts[k], 16, 2);
  for (const float sigma : rims.sigmas) EXPECT_NEAR(sigma, RimParams().noise * kPixel * 2.05, 5e-4);
}

TEST(FindRims, RimOfAWindowIsTheWallsAndPointsIntoIt) {
  const Board window = boardAt(2.0);
  const Rims rims = findRims(hole(window, 0.3), SensorModel(), RimParams());
  const Eigen::Array4i counts = expectOnEdges(rims, window, -1.0, 1.5);
  EXPECT_TRUE((counts > 10).all()) << counts.transpose();
}

TEST(FindRims, NothingBehindIsNoRim) {
  EXPECT_EQ(findRims(hole(boardAt(2.0), kNothing), SensorModel(), RimParams()).size(), 0u);
}

TEST(FindRims, StepWithinNoiseIsNoRim) {
  EXPECT_EQ(findRims(hole(boardAt(3.0), 0.08), SensorModel(), RimParams()).size(), 0u);
}

TEST(FindRims, ShadowBesideTheBoardIsBridged) {
  const Board board = boardAt(2.0);
  const PointCloud cloud = test::renderDepth({}, [&](const Vector3d& ray) {
    Board shadow = board;
    shadow.camera_from_board.translation().y() -= 20.0 * kPixel * 2.0;
    const double range = board.range(ray);
    if (!std::isnan(range)) return range;
    return std::isnan(shadow.range(ray)) ? wallRange(ray, 3.0) : kNothing;
  });
  const Eigen::Array4i counts =
      expectOnEdges(findRims(cloud, SensorModel(), RimParams()), board, 1.0, 1.5);
  for (const int k : {0, 1}) EXPECT_NEAR(counts[k], 13, 2);
}

TEST(FindRims, NoneInRoomsWithoutSteps) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const Eigen::Matrix3d turn = random.rotation();
    std::vector<Plane> walls;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0})
        walls.push_back(Plane::fromPointNormal(-side * random.uniform(0.6, 3.0) * turn.col(axis),
                                               side * turn.col(axis)));
    }
    PointCloud cloud = test::renderDepth({}, test::insideOf(walls));
    test::addRangeNoise(cloud, SensorModel(), random);
    EXPECT_EQ(findRims(cloud, SensorModel(), RimParams()).size(), 0u) << "seed " << seed;
  }
}

TEST(FindRims, NoisyBoardsHowTheyMayStand) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    Board board = boardAt(random.uniform(1.5, 3.0));
    board.camera_from_board.linear() =
        random.motion(degToRad(50.0), 0.0).linear() *
        Eigen::AngleAxisd(random.uniform(-kPi, kPi), Vector3d::UnitX()).toRotationMatrix();
    PointCloud cloud = boardBeforeWall(board, 4.5);
    test::addRangeNoise(cloud, SensorModel(), random);
    const Eigen::Array4i counts =
        expectOnEdges(findRims(cloud, SensorModel(), RimParams()), board, 1.0, 4.0);
    EXPECT_GT((counts > 2).count(), 1) << "seed " << seed << ": " << counts.transpose();
  }
}

TEST(FindRims, OnlyDepthImagesHaveThem) {
  PointCloud cloud = boardBeforeWall(boardAt(2.0), 3.0);
  cloud.columns_wrap = true;
  EXPECT_EQ(findRims(cloud, SensorModel(), RimParams()).size(), 0u);
  cloud.columns_wrap = false;
  cloud.rows = cloud.cols = 0;
  EXPECT_EQ(findRims(cloud, SensorModel(), RimParams()).size(), 0u);
  cloud.points.clear();
  EXPECT_EQ(findRims(cloud, SensorModel(), RimParams()).size(), 0u);
}

TEST(FindRims, PointsThatAreOneHaveNone) {
  PointCloud cloud;
  cloud.rows = 40, cloud.cols = 40;
  for (int i = 0; i < 1600; ++i)
    cloud.points.emplace_back(i % 40 < 20 ? 1.0F : 3.0F, 0.0F, 0.0F);  // on one ray
  EXPECT_EQ(findRims(cloud, SensorModel(), RimParams()).size(), 0u);
}

TEST(FindRims, GridMustFitThePoints) {
  PointCloud cloud = boardBeforeWall(boardAt(2.0), 3.0);
  cloud.rows -= 1;
  EXPECT_THROW(findRims(cloud, SensorModel(), RimParams()), std::invalid_argument);
}

}  // namespace
}  // namespace opp
