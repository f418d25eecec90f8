// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/primitives/find_lines.h"

#include "primitives/sample_pitch.h"
#include "support/random.h"
#include "support/refined_scene.h"
#include "support/synthetic_room.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace opp {
namespace {

using test::Rectangles;
using test::SyntheticOptions;
using test::SyntheticScene;

TEST(FindLines, EdgesOfARoomAreConcaveAndEndInItsCorners) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d size(random.uniform(1.0, 4.0), random.uniform(1.0, 4.0),
                               random.uniform(1.0, 4.0));
    SyntheticOptions options;
    options.seed = static_cast<std::uint64_t>(k);
    options.spacing = 0.08;
    const SyntheticScene scene = test::sampleScene(test::roomSides(-0.5 * size, 0.5 * size),
                                                   {0.1, 0.1, 0.1}, random.pose(3.0), options);
    const Primitives result = test::refinedScene(scene, random);
    ASSERT_EQ(result.lines.size(), 12U);
    double total = 0.0;
    for (const LineSegment& line : result.lines) {
      EXPECT_EQ(line.kind, LineKind::kConcave);
      total += (line.end - line.start).norm();
    }
    EXPECT_NEAR(total, 4.0 * size.sum(), 1e-5);  // 24 ends, float32 coordinates
  }
}

TEST(FindLines, EdgesOfACubeSeenFromOutsideAreConvex) {
  test::Random random(2);
  const SyntheticScene scene =
      test::sampleScene(test::boxSides({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), {2.0, 1.5, 1.0},
                        random.pose(1.0), SyntheticOptions());
  const Primitives result = test::refinedScene(scene, random);
  ASSERT_EQ(result.lines.size(), 3U);
  for (const LineSegment& line : result.lines) {
    EXPECT_EQ(line.kind, LineKind::kConvex);
    // One end is the corner, the other the last sample: within a spacing of the cube's edge.
    EXPECT_NEAR((line.end - line.start).norm(), 1.0, scene.cloud.spacing);
  }
}

TEST(FindLines, ADoorCutsTheLineBetweenFloorAndWall) {
  test::Random random(3);
  const Rectangles rectangles = {{{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 1.0, 0.0}},
                                 {{-1.25, 1.0, 1.0}, {0.75, 0.0, 0.0}, {0.0, 0.0, 1.0}},
                                 {{1.25, 1.0, 1.0}, {0.75, 0.0, 0.0}, {0.0, 0.0, 1.0}}};
  const SyntheticScene scene =
      test::sampleScene(rectangles, {0.0, 0.0, 1.0}, random.pose(1.0), SyntheticOptions());
  ASSERT_EQ(scene.planes.size(), 2U);
  const Primitives result = test::refinedScene(scene, random);
  ASSERT_EQ(result.lines.size(), 2U);
  for (const LineSegment& line : result.lines) {
    EXPECT_EQ(line.planes, (std::array<int, 2>{0, 1}));
    EXPECT_EQ(line.kind, LineKind::kConcave);
    EXPECT_NEAR((line.end - line.start).norm(), 1.5, 2.0 * scene.cloud.spacing);
  }
}

/// A floor (z = 0) and a wall (y = 0) with samples of extent `extent` in two rows beside the line
/// between them, 4 extents apart along 2 m of it.
std::vector<LineSegment> linesOfSparseRows(const Eigen::Vector3d& viewpoint, double extent) {
  OrientedCloud cloud;
  cloud.spacing = extent;
  cloud.viewpoint = viewpoint.cast<float>();
  Primitives scan;
  scan.planes.resize(2);
  const std::array<Eigen::Vector3d, 2> normals{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY()};
  for (std::size_t k = 0; k < 2; ++k) {
    scan.planes[k].plane = Plane::fromPointNormal({0.0, 0.0, 0.0}, normals[k]);
    for (double x = 0.0; x <= 2.0; x += 4.0 * extent) {
      for (const double beside : {extent, 2.0 * extent}) {
        const Eigen::Vector3d point = x * Eigen::Vector3d::UnitX() + beside * normals[1 - k];
        scan.planes[k].moments.add(point);
        cloud.points.push_back(point.cast<float>());
        cloud.normals.push_back(normals[k].cast<float>());
        cloud.sigmas.push_back(0.001F);
        cloud.weights.push_back(1.0F);
        scan.labels.push_back(static_cast<int>(k));
      }
    }
  }
  scan.edges.push_back({{0, 1}, 0.0});
  return findLines(cloud, scan, LineParams());
}

TEST(FindLines, GapsAreAsLongAsTheSurfaceIsSeenFlat) {
  test::Random random(4);
  for (int k = 0; k < 50; ++k) {
    const double extent = random.uniform(0.02, 0.05);
    // Rays along the line, at a cosine of 0.1 to 0.33 to both planes: samples may stand 1.7 extents
    // apart at least, so that 4 are no gap.
    const double height = random.uniform(0.25, 0.35);
    const auto along = linesOfSparseRows({-1.0, height, height}, extent);
    ASSERT_EQ(along.size(), 1U);
    EXPECT_NEAR((along[0].end - along[0].start).norm(), 2.0, 4.0 * extent);
    // From across the line, 4 extents are empty.
    EXPECT_TRUE(linesOfSparseRows({1.0, 3.0, 3.0}, extent).empty());
  }
}

TEST(PitchAlong, IsLongWhereRaysSlant) {
  // A cosine of 1/4: a square of rays covers 4 × 1, the square of that area has an edge of 2.
  const Eigen::Vector3d ray(std::sqrt(15.0), 0.0, -1.0);
  EXPECT_NEAR(pitchAlong(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(), ray), 2.0, 1e-12);
  EXPECT_EQ(pitchAlong(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(), ray), 1.0);
  EXPECT_EQ(pitchAlong(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(),
                       Eigen::Vector3d(0.0, 0.0, -2.0)),
            1.0);
  EXPECT_EQ(pitchAlong(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()),
            1.0);
}

TEST(FindLines, NothingIsFoundInNothing) {
  EXPECT_TRUE(findLines(OrientedCloud(), Primitives(), LineParams()).empty());
}

TEST(FindLines, RejectsInputThatDoesNotFitTogether) {
  Primitives scan;
  scan.labels = {0};
  EXPECT_THROW(findLines(OrientedCloud(), scan, LineParams()), std::invalid_argument);
  LineParams params;
  params.reach = 0.0;
  EXPECT_THROW(findLines(OrientedCloud(), Primitives(), params), std::invalid_argument);
}

}  // namespace
}  // namespace opp
