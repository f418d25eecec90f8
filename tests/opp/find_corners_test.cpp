// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/primitives/find_corners.h"

#include "support/random.h"
#include "support/refined_scene.h"
#include "support/synthetic_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace opp {
namespace {

using test::Rectangles;
using test::SyntheticOptions;
using test::SyntheticScene;

const Eigen::Vector3d kLow(-2.0, -1.5, -1.2), kHigh(2.5, 1.8, 1.3);

/// The eight vertices of the box, in the cloud's frame.
std::vector<Eigen::Vector3d> vertices(const Eigen::Isometry3d& cloud_from_scene) {
  std::vector<Eigen::Vector3d> result;
  for (int k = 0; k < 8; ++k) {
    result.push_back(cloud_from_scene * Eigen::Vector3d((k & 1) != 0 ? kHigh.x() : kLow.x(),
                                                        (k & 2) != 0 ? kHigh.y() : kLow.y(),
                                                        (k & 4) != 0 ? kHigh.z() : kLow.z()));
  }
  return result;
}

double distanceToNearest(const Eigen::Vector3d& x, const std::vector<Eigen::Vector3d>& points) {
  double nearest = 1e9;
  for (const Eigen::Vector3d& point : points) nearest = std::min(nearest, (x - point).norm());
  return nearest;
}

void expectExactCorners(const std::vector<Corner>& corners, const Eigen::Isometry3d& pose,
                        double tolerance) {
  const std::vector<Eigen::Vector3d> truth = vertices(pose);
  std::vector<Eigen::Vector3d> found;
  for (const Corner& corner : corners) {
    found.push_back(corner.position);
    EXPECT_LT(distanceToNearest(corner.position, truth), tolerance);
    const Eigen::Matrix3d& frame = corner.cloud_from_corner;
    EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(frame.determinant(), 1.0, 1e-12);
  }
  for (const Eigen::Vector3d& vertex : truth) {
    EXPECT_LT(distanceToNearest(vertex, found), tolerance);
  }
}

TEST(FindTriangles, NeedsAllThreeEdges) {
  EXPECT_TRUE(findTriangles({}).empty());
  EXPECT_TRUE(findTriangles({{{0, 1}, 1.0}, {{1, 2}, 1.0}}).empty());
  const auto triangles =
      findTriangles({{{1, 2}, 1.0}, {{0, 2}, 1.0}, {{0, 1}, 1.0}, {{2, 3}, 1.0}, {{1, 3}, 1.0}});
  ASSERT_EQ(triangles.size(), 2U);
  EXPECT_EQ(triangles[0], (std::array<int, 3>{0, 1, 2}));
  EXPECT_EQ(triangles[1], (std::array<int, 3>{1, 2, 3}));
}

TEST(FindCorners, RoomFromInsideHasEightExactConcaveCorners) {
  test::Random random(1);
  for (int k = 0; k < 10; ++k) {
    const Eigen::Isometry3d pose = random.pose(2.0);
    SyntheticOptions options;
    options.normal_sigma = 0.02;
    const SyntheticScene scene =
        test::sampleScene(test::roomSides(kLow, kHigh), {0.2, 0.1, 0.0}, pose, options);
    const Primitives result = test::refinedScene(scene, random);
    EXPECT_EQ(result.planes.size(), 6U);
    EXPECT_EQ(result.lines.size(), 12U);
    ASSERT_EQ(result.corners.size(), 8U);
    expectExactCorners(result.corners, pose, 1e-6);
    for (const Corner& corner : result.corners) {
      EXPECT_EQ(corner.kind, CornerKind::kConcave);
      // Each plane in front of both others: quadrant 3 of each.
      EXPECT_EQ(corner.signature, 0x888);
      EXPECT_EQ(corner.view_octant, 7);
    }
  }
}

TEST(FindCorners, CubeFromAllAroundHasEightExactCorners) {
  test::Random random(2);
  for (int k = 0; k < 10; ++k) {
    const Eigen::Isometry3d pose = random.pose(2.0);
    const Eigen::Vector3d viewpoint(5.0, 4.0, 3.0);
    SyntheticOptions options;
    options.normal_sigma = 0.02;
    options.occlusion = false;
    const SyntheticScene scene =
        test::sampleScene(test::boxFromAllSides(kLow, kHigh, viewpoint), viewpoint, pose, options);
    const Primitives result = test::refinedScene(scene, random);
    EXPECT_EQ(result.planes.size(), 6U);
    EXPECT_EQ(result.lines.size(), 12U);
    ASSERT_EQ(result.corners.size(), 8U);
    expectExactCorners(result.corners, pose, 1e-6);
  }
}

TEST(FindCorners, CubeFromOneSideShowsOneConvexCorner) {
  test::Random random(3);
  const SyntheticScene scene =
      test::sampleScene(test::boxSides({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), {2.0, 1.5, 1.0},
                        random.pose(1.0), SyntheticOptions());
  const Primitives result = test::refinedScene(scene, random);
  ASSERT_EQ(result.corners.size(), 1U);
  EXPECT_EQ(result.corners[0].kind, CornerKind::kConvex);
  EXPECT_EQ(result.corners[0].signature, 0x111);
}

TEST(FindCorners, BoxOnTheFloorMakesSaddles) {
  test::Random random(4);
  Rectangles rectangles = test::boxSides({-0.5, -0.5, 0.0}, {0.5, 0.5, 1.0});
  rectangles.push_back({{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 2.0, 0.0}});
  const SyntheticScene scene =
      test::sampleScene(rectangles, {2.5, 2.0, 2.0}, random.pose(1.0), SyntheticOptions());
  const Primitives result = test::refinedScene(scene, random);
  int saddles = 0, convex = 0;
  for (const Corner& corner : result.corners) {
    if (corner.kind == CornerKind::kSaddle) ++saddles;
    if (corner.kind == CornerKind::kConvex) ++convex;
  }
  EXPECT_EQ(result.corners.size(), 2U);  // the vertical edge in front: its top and its foot
  EXPECT_EQ(saddles, 1);
  EXPECT_EQ(convex, 1);
}

TEST(FindCorners, PlanesThatEndFarFromTheirCommonPointMakeNone) {
  // Three sides of a room that leave 1 m free around their corner, joined by edges nevertheless.
  test::Random random(5);
  const Rectangles rectangles = {{{2.0, 2.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}},
                                 {{0.0, 2.0, 2.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
                                 {{2.0, 0.0, 2.0}, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}}};
  SyntheticScene scene =
      test::sampleScene(rectangles, {2.0, 2.0, 2.0}, random.pose(1.0), SyntheticOptions());
  ASSERT_EQ(scene.planes.size(), 3U);
  scene.edges = {{0, 1}, {0, 2}, {1, 2}};
  const Primitives result = test::refinedScene(scene, random);
  EXPECT_EQ(result.edges.size(), 3U);
  EXPECT_TRUE(result.corners.empty());
  EXPECT_TRUE(result.lines.empty());
}

TEST(FindCorners, CovariancePredictsTheErrorsOf500NoisyScans) {
  test::Random random(6);
  double normalized = 0.0;
  const int scans = 500;
  for (int k = 0; k < scans; ++k) {
    const Eigen::Isometry3d pose = random.pose(2.0);
    SyntheticOptions options;
    options.spacing = 0.2;
    options.sigma = 0.005;
    options.normal_sigma = 0.05;
    options.seed = static_cast<std::uint64_t>(k);
    const SyntheticScene scene =
        test::sampleScene(test::roomSides(kLow, kHigh), {0.2, 0.1, 0.0}, pose, options);
    const Primitives result = test::refinedScene(scene, random);
    ASSERT_EQ(result.corners.size(), 8U) << k;
    // One corner a scan: those of one scan share their errors.
    const Corner& corner = result.corners[static_cast<std::size_t>(k) % 8];
    const std::vector<Eigen::Vector3d> truth = vertices(pose);
    const Eigen::Vector3d error =
        corner.position -
        *std::min_element(truth.begin(), truth.end(), [&](const auto& a, const auto& b) {
          return (a - corner.position).norm() < (b - corner.position).norm();
        });
    normalized += error.dot(corner.covariance.ldlt().solve(error));
  }
  // Mean of 500 χ²₃: 3 ± 3·√(6/500) = 3 ± 0.33.
  EXPECT_NEAR(normalized / scans, 3.0, 0.33);
}

TEST(FindCorners, NothingIsFoundInNothing) {
  EXPECT_TRUE(findCorners(OrientedCloud(), Primitives(), CornerParams()).empty());
}

TEST(FindCorners, RejectsInputThatDoesNotFitTogether) {
  Primitives scan;
  scan.labels = {0};
  EXPECT_THROW(findCorners(OrientedCloud(), scan, CornerParams()), std::invalid_argument);
  scan.labels.clear();
  scan.families.resize(1);
  EXPECT_THROW(findCorners(OrientedCloud(), scan, CornerParams()), std::invalid_argument);
  CornerParams params;
  params.radius = -1.0;
  EXPECT_THROW(findCorners(OrientedCloud(), Primitives(), params), std::invalid_argument);
}

}  // namespace
}  // namespace opp
