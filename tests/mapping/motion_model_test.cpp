// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/motion_model.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

/// Pose at time t of a body that turns and moves at a constant rate in the map's frame.
Eigen::Isometry3d moving(const Eigen::Isometry3d& start, const Vector6d& rate, double t) {
  return retract(start, t * rate);
}

TEST(MotionModel, KnowsNothingBeforeTheFirstPose) {
  const PosePrior prior = MotionModel(FrontendParams{}).predict(1.0, std::nullopt);
  EXPECT_TRUE(prior.map_from_body.matrix().isIdentity());
  EXPECT_TRUE(prior.information.isZero());
}

TEST(MotionModel, StaysPutWhileNoVelocityIsKnown) {
  MotionModel model(FrontendParams{});
  const Eigen::Isometry3d pose = test::Random(1).pose(3.0);
  model.update({10.0, pose}, std::nullopt);
  EXPECT_TRUE(model.predict(10.5, std::nullopt).map_from_body.isApprox(pose, 1e-12));
}

TEST(MotionModel, PredictsConstantVelocityExactlyAtUnevenTimes) {
  test::Random random(2);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d start = random.pose(3.0);
    Vector6d rate;
    rate << random.vector(1.0), random.vector(1.0);
    MotionModel model(FrontendParams{});
    model.update({0.0, start}, std::nullopt);
    model.update({0.3, moving(start, rate, 0.3)}, std::nullopt);
    const PosePrior prior = model.predict(0.8, std::nullopt);
    EXPECT_TRUE(prior.map_from_body.isApprox(moving(start, rate, 0.8), 1e-9));
  }
}

TEST(MotionModel, TrustsItselfLessTheLongerAgo) {
  MotionModel model(FrontendParams{});
  model.update({0.0, Eigen::Isometry3d::Identity()}, std::nullopt);
  model.update({0.1, Eigen::Isometry3d::Identity()}, std::nullopt);
  const Matrix6d soon = model.predict(0.2, std::nullopt).information;
  const Matrix6d late = model.predict(1.1, std::nullopt).information;
  for (int k = 0; k < 6; ++k) EXPECT_GT(soon(k, k), late(k, k));
}

TEST(MotionModel, FollowsOdometryWhereThereIsSome) {
  test::Random random(3);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d map_from_body = random.pose(3.0), odom_from_body = random.pose(3.0);
    const Eigen::Isometry3d step = random.motion(0.5, 0.5);
    MotionModel model(FrontendParams{});
    model.update({0.0, map_from_body}, odom_from_body);
    const PosePrior prior = model.predict(0.1, odom_from_body * step);
    EXPECT_TRUE(prior.map_from_body.isApprox(map_from_body * step, 1e-9));
  }
}

TEST(MotionModel, KeepsItsVelocityInTheBodyWhenTheMapMoves) {
  test::Random random(4);
  const Eigen::Isometry3d first = random.pose(3.0), second = first * random.motion(0.2, 0.2);
  const Eigen::Isometry3d new_from_old = random.pose(1.0);
  MotionModel model(FrontendParams{});
  model.update({0.0, first}, std::nullopt);
  model.update({0.1, second}, std::nullopt);
  const Eigen::Isometry3d before = model.predict(0.2, std::nullopt).map_from_body;
  model.correct(new_from_old * second);
  const Eigen::Isometry3d after = model.predict(0.2, std::nullopt).map_from_body;
  EXPECT_TRUE(after.isApprox(new_from_old * before, 1e-9));
}

TEST(MotionModel, StampsThatDoNotAdvanceGiveFinitePredictions) {
  MotionModel model(FrontendParams{});
  model.update({5.0, Eigen::Isometry3d::Identity()}, std::nullopt);
  model.update({5.0, test::Random(5).pose(1.0)}, std::nullopt);
  const PosePrior prior = model.predict(4.0, std::nullopt);
  EXPECT_TRUE(prior.map_from_body.matrix().allFinite());
  EXPECT_TRUE(prior.information.allFinite());
}

}  // namespace
}  // namespace opp::mapping
