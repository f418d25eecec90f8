// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/primitives/find_lines.h"

#include "support/random.h"
#include "support/refined_scene.h"
#include "support/synthetic_room.h"

#include <gtest/gtest.h>

#include <stdexcept>

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
