// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detect_primitives.h"

#include "opp/geometry/constants.h"

#include "support/degenerate_clouds.h"
#include "support/random.h"
#include "support/synthetic_room.h"

#include <gtest/gtest.h>

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
