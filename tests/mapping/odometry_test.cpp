// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/odometry.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

TEST(DriftingOdometry, WithoutErrorsSumsUpTheTrueMotion) {
  test::Random random(8);
  OdometryModel model;
  model.scale_error = model.distance_noise = 0.0;
  model.turn_noise_per_distance = model.turn_noise_per_turn = 0.0;
  DriftingOdometry odometry(model, false, 1);
  Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
  for (int step = 0; step < 60; ++step) {
    const Eigen::Isometry3d motion = random.motion(0.3, 0.2);
    truth = truth * motion;
    EXPECT_TRUE(odometry.move(motion).isApprox(truth, 1e-10));
  }
}

TEST(DriftingOdometry, DriftGrowsWithTheRootOfTheWay) {
  OdometryModel model;
  model.scale_error = model.turn_noise_per_distance = model.turn_noise_per_turn = 0.0;
  double squares = 0.0;
  const int runs = 400;
  for (int run = 0; run < runs; ++run) {
    DriftingOdometry odometry(model, true, static_cast<std::uint64_t>(run));
    Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
    step.translation().x() = 0.1;
    for (int k = 0; k < 90; ++k) odometry.move(step);
    squares += std::pow(odometry.odomFromBody().translation().x() - 9.0, 2);
    EXPECT_EQ(odometry.odomFromBody().translation().z(), 0.0);  // planar
  }
  // 9 m of way: 0.01 · √9; four standard deviations of the estimate are 4/√800 = 14 %.
  EXPECT_NEAR(std::sqrt(squares / runs), 0.03, 0.14 * 0.03);
}

TEST(DriftingOdometry, StandingStillDoesNotDriftAndSeedsRepeat) {
  DriftingOdometry odometry({}, false, 3), same({}, false, 3), other({}, false, 4);
  EXPECT_TRUE(
      odometry.move(Eigen::Isometry3d::Identity()).isApprox(Eigen::Isometry3d::Identity(), 1e-15));
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
  step.translation().x() = 1.0;
  same.move(Eigen::Isometry3d::Identity());
  other.move(Eigen::Isometry3d::Identity());
  EXPECT_TRUE(odometry.move(step).matrix() == same.move(step).matrix());
  EXPECT_FALSE(odometry.odomFromBody().matrix() == other.move(step).matrix());
  OdometryModel bad;
  bad.distance_noise = -1.0;
  EXPECT_THROW(DriftingOdometry(bad, true, 1), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
