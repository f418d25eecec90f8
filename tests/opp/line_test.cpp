// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/line.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp {
namespace {

TEST(Line, IsTheCommonLineOfTwoPlanes) {
  const Plane floor = Plane::fromCoefficients({0, 0, 1}, 0.0);
  const Plane wall = Plane::fromCoefficients({1, 0, 0}, -2.0);
  const std::optional<Line> line = intersect(wall, floor);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->origin, Eigen::Vector3d(2, 0, 0));
  EXPECT_EQ(line->direction, Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(line->parameterOf({7, -3, 5}), 3.0);
  EXPECT_EQ(line->at(3.0), Eigen::Vector3d(2, -3, 0));
}

TEST(Line, LiesOnBothPlanesAndStartsNearestToTheOrigin) {
  test::Random random(1);
  for (int k = 0; k < 100; ++k) {
    const Plane a = Plane::fromPointNormal(random.vector(5.0), random.unitVector());
    const Plane b = Plane::fromPointNormal(random.vector(5.0), random.unitVector());
    if (a.normal().cross(b.normal()).norm() < 0.1) continue;  // ill-conditioned: its own test below
    const std::optional<Line> line = intersect(a, b);
    ASSERT_TRUE(line);
    for (const double s : {-3.0, 0.0, 3.0}) {
      // |x| is up to 5 m / sin 0.1 = 50 m; rounding of that is 1e-14, amplified tenfold.
      EXPECT_NEAR(a.signedDistance(line->at(s)), 0.0, 1e-11);
      EXPECT_NEAR(b.signedDistance(line->at(s)), 0.0, 1e-11);
    }
    EXPECT_NEAR(line->direction.dot(line->origin), 0.0, 1e-11);
    EXPECT_NEAR(line->direction.norm(), 1.0, 1e-12);
  }
}

TEST(Line, ParallelPlanesHaveNone) {
  const Plane plane = Plane::fromCoefficients({1, 2, 3}, 4.0);
  EXPECT_FALSE(intersect(plane, plane));
  EXPECT_FALSE(intersect(plane, plane.flipped()));
  EXPECT_FALSE(intersect(plane, Plane::fromCoefficients({1, 2, 3}, 5.0)));
}

}  // namespace
}  // namespace opp
