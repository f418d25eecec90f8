// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/se3.h"

#include "opp/geometry/constants.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

TEST(Retract, TurnsAndShiftsInTheParentFrame) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  Vector6d omega_v;
  omega_v << 0.0, 0.0, kPi / 2.0, 0.5, 0.0, 0.0;
  const Eigen::Isometry3d moved = retract(pose, omega_v);
  // Body x turns to parent y; the translation is not rotated.
  EXPECT_TRUE((moved * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1.5, 3.0, 3.0), 1e-12));
}

TEST(Retract, IsUndoneByDifference) {
  test::Random random(1);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Isometry3d from = random.pose(5.0), to = random.pose(5.0);
    const Eigen::Isometry3d back = retract(from, difference(from, to));
    EXPECT_TRUE(back.matrix().isApprox(to.matrix(), 1e-12));
    Vector6d small;
    small << random.vector(1e-3), random.vector(1.0);
    EXPECT_TRUE(difference(from, retract(from, small)).isApprox(small, 1e-9));
  }
}

TEST(Difference, IsExactNearZeroAndNearHalfATurn) {
  test::Random random(2);
  for (const double angle : {0.0, 1e-12, 1e-8, 1e-4, kPi - 1e-4, kPi - 1e-8, kPi}) {
    const Eigen::Isometry3d from = random.pose(2.0);
    Vector6d omega_v = Vector6d::Zero();
    omega_v.head<3>() = angle * random.unitVector();
    const Vector6d measured = difference(from, retract(from, omega_v));
    // At half a turn the axis may come back reversed: the rotation is the same.
    EXPECT_NEAR(measured.head<3>().norm(), angle, 1e-12);
    EXPECT_NEAR(rotationAngle(retract(from, measured).inverse() * retract(from, omega_v)), 0.0,
                1e-7);
  }
}

TEST(Difference, IsAntisymmetricInTranslationAndAngle) {
  test::Random random(3);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Isometry3d a = random.pose(5.0), b = random.pose(5.0);
    // ω is an axis fixed under its own rotation, so going back is exactly −ω.
    EXPECT_TRUE(difference(a, b).isApprox(-difference(b, a), 1e-9));
  }
}

TEST(Normalized, KeepsLongChainsOfPosesRigid) {
  test::Random random(4);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int k = 0; k < 10000; ++k) pose = normalized(pose * random.motion(0.1, 0.1));
  EXPECT_TRUE((pose.linear().transpose() * pose.linear()).isIdentity(1e-12));
  EXPECT_NEAR(pose.linear().determinant(), 1.0, 1e-12);
}

TEST(RotationAngle, IsThatOfTheAngleAxis) {
  test::Random random(5);
  for (int k = 0; k < 100; ++k) {
    const double angle = random.uniform(0.0, kPi);
    Eigen::Isometry3d pose = random.pose(5.0);
    pose.linear() = Eigen::AngleAxisd(angle, random.unitVector()).toRotationMatrix();
    EXPECT_NEAR(rotationAngle(pose), angle, 1e-9);
  }
}

}  // namespace
}  // namespace opp::mapping
