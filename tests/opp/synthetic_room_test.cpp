// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/synthetic_room.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::test {
namespace {

TEST(SyntheticRoom, RoomFromInsideHasSixPlanesAndTwelveEdges) {
  const SyntheticScene scene = sampleScene(roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5}),
                                           {0.3, 0.2, 1.2}, Eigen::Isometry3d::Identity(), {});
  EXPECT_EQ(scene.planes.size(), 6U);
  EXPECT_EQ(scene.edges.size(), 12U);
}

TEST(SyntheticRoom, BoxFromOutsideShowsThreeSides) {
  const SyntheticScene scene = sampleScene(boxSides({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}),
                                           {4.0, 3.0, 2.0}, Eigen::Isometry3d::Identity(), {});
  EXPECT_EQ(scene.planes.size(), 3U);
  EXPECT_EQ(scene.edges.size(), 3U);
}

TEST(SyntheticRoom, SamplesLieOnTheirPlanesAndFaceTheViewpoint) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    SyntheticOptions options;
    options.outlier_ratio = 0.1;
    options.seed = seed;
    const SyntheticScene scene =
        sampleScene(furnishedRoom(seed), {0.0, 0.0, 1.5}, random.pose(3.0), options);
    ASSERT_EQ(scene.labels.size(), scene.cloud.size());
    ASSERT_GE(scene.planes.size(), 8U);
    const Eigen::Vector3d eye = scene.cloud.viewpoint.cast<double>();
    for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
      const Eigen::Vector3d x = scene.cloud.points[i].cast<double>();
      EXPECT_GE(scene.cloud.normals[i].cast<double>().dot(eye - x), -1e-4);
      if (scene.labels[i] < 0) continue;
      const Plane& plane = scene.planes[static_cast<std::size_t>(scene.labels[i])];
      EXPECT_GT(plane.signedDistance(eye), 0.0);
      // float32 points within a few metres: 1e-6 m.
      EXPECT_NEAR(plane.signedDistance(x), 0.0, 3e-6);
    }
  }
}

}  // namespace
}  // namespace opp::test
