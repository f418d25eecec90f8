// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/plane.h"

#include "opp/geometry/constants.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace opp {
namespace {

TEST(Plane, ScalesNormalAndOffsetTogether) {
  const Plane plane = Plane::fromCoefficients({0.0, 0.0, 2.0}, -6.0);
  EXPECT_EQ(plane.normal(), Eigen::Vector3d::UnitZ());
  EXPECT_DOUBLE_EQ(plane.d(), -3.0);
  EXPECT_DOUBLE_EQ(plane.signedDistance({5.0, 1.0, 4.0}), 1.0);
}

TEST(Plane, RejectsWhatIsNoPlane) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Plane::fromCoefficients({0.0, 0.0, 0.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(Plane::fromCoefficients({nan, 0.0, 1.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(Plane::fromCoefficients({1.0, 0.0, 0.0}, nan), std::invalid_argument);
}

TEST(Plane, OfAUnitNormalKeepsEveryBit) {
  test::Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const Plane plane = Plane::fromPointNormal(random.vector(9.0), random.vector(2.0));
    const Plane again = Plane::fromUnitNormal(plane.normal(), plane.d());
    EXPECT_EQ(again.normal(), plane.normal());
    EXPECT_EQ(again.d(), plane.d());
  }
  EXPECT_THROW(Plane::fromUnitNormal({0.0, 0.0, 1.001}, 0.0), std::invalid_argument);
  EXPECT_THROW(Plane::fromUnitNormal({0.0, 0.0, std::nan("")}, 0.0), std::invalid_argument);
  EXPECT_THROW(Plane::fromUnitNormal({0.0, 0.0, 1.0}, std::nan("")), std::invalid_argument);
}

TEST(Plane, TransformKeepsSignedDistances) {
  test::Random random(1);
  for (int k = 0; k < 100; ++k) {
    const Plane plane_in_a = Plane::fromPointNormal(random.vector(5.0), random.unitVector());
    const Eigen::Isometry3d b_from_a = random.pose(5.0);
    const Eigen::Vector3d x_in_a = random.vector(5.0);
    const Plane plane_in_b = transformed(b_from_a, plane_in_a);
    EXPECT_NEAR(plane_in_b.signedDistance(b_from_a * x_in_a), plane_in_a.signedDistance(x_in_a),
                1e-12);
    EXPECT_NEAR(plane_in_b.signedDistance(plane_in_b.project(x_in_a)), 0.0, 1e-12);
  }
}

TEST(Plane, AngleIsAccurateNearZeroAndRightAngles) {
  const Plane z;
  for (const double angle : {0.0, 1e-9, 1e-3, kPi / 2 - 1e-9, kPi / 2, kPi - 1e-9}) {
    const Plane tilted = Plane::fromCoefficients({std::sin(angle), 0.0, std::cos(angle)}, 0.0);
    EXPECT_NEAR(angleBetween(z, tilted), angle, 1e-15 + 1e-12 * angle);
  }
}

TEST(TangentBasis, CompletesANormalToARightHandedFrame) {
  test::Random random(2);
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector3d normal = k == 0   ? Eigen::Vector3d(0.0, 0.0, -1.0)
                                   : k == 1 ? Eigen::Vector3d(0.0, 0.0, 1.0)
                                            : random.unitVector();
    Eigen::Matrix3d frame;
    frame << tangentBasis(normal), normal;
    EXPECT_TRUE((frame.transpose() * frame).isIdentity(1e-12)) << normal.transpose();
    EXPECT_NEAR(frame.determinant(), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace opp
