// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/motion_model.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

/// Information of a pose known to a micrometre: exact, for our purpose.
Matrix6d exact() { return 1e12 * Matrix6d::Identity(); }

double sigma(const PosePrior& prior, int k) {
  return std::sqrt(Matrix6d(prior.information.inverse())(k, k));
}

TEST(MotionModel, StaysPutWhileNoVelocityIsKnown) {
  MotionModel model(FrontendParams{});
  const Eigen::Isometry3d pose = test::Random(1).pose(3.0);
  model.start({10.0, pose}, std::nullopt);
  EXPECT_TRUE(model.predict(10.5, std::nullopt).map_from_body.isApprox(pose, 1e-12));
}

TEST(MotionModel, LearnsAConstantVelocityAtUnevenTimes) {
  test::Random random(2);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d start = random.pose(3.0);
    Vector6d rate;
    rate << random.vector(1.0), random.vector(1.0);
    MotionModel model(FrontendParams{});
    model.start({0.0, start}, std::nullopt);
    double time = 0.0;
    for (int step = 0; step < 20; ++step) {
      time += random.uniform(0.05, 0.1);
      model.update({time, moving(start, rate, time)}, std::nullopt, exact());
    }
    // Exact poses and white accelerations: a wrong velocity shrinks by 2 - √3 a step.
    const PosePrior prior = model.predict(time + 0.5, std::nullopt);
    EXPECT_TRUE(prior.map_from_body.isApprox(moving(start, rate, time + 0.5), 1e-6));
  }
}

TEST(MotionModel, TrustsItselfLessTheLongerAgo) {
  MotionModel model(FrontendParams{});
  model.start({0.0, Eigen::Isometry3d::Identity()}, std::nullopt);
  model.update({0.1, Eigen::Isometry3d::Identity()}, std::nullopt, exact());
  const PosePrior soon = model.predict(0.2, std::nullopt), late = model.predict(1.1, std::nullopt);
  for (int k = 0; k < 6; ++k) EXPECT_GT(sigma(late, k), 2.0 * sigma(soon, k));
}

TEST(MotionModel, ADirectionThatNoScanFixesGrowsUncertainTheOthersDoNot) {
  Matrix6d all_but_x = exact();
  all_but_x(3, 3) = 0.0;
  MotionModel model(FrontendParams{});
  model.start({0.0, Eigen::Isometry3d::Identity()}, std::nullopt);
  for (int step = 1; step <= 10; ++step)
    model.update({0.1 * step, Eigen::Isometry3d::Identity()}, std::nullopt, exact());
  const double first = sigma(model.predict(1.1, std::nullopt), 3);
  double last = 0.0;
  for (int step = 11; step <= 20; ++step) {
    const PosePrior prior = model.predict(0.1 * step, std::nullopt);
    EXPECT_GT(sigma(prior, 3), last);
    EXPECT_NEAR(sigma(prior, 4), first, 1e-3 * first);
    last = sigma(prior, 3);
    model.update({0.1 * step, Eigen::Isometry3d::Identity()}, std::nullopt, all_but_x);
  }
  // White accelerations alone: a·√(0.1 s·t³/3) after t = 1 s; the velocity was not exact before.
  EXPECT_GT(last, FrontendParams().acceleration * std::sqrt(0.1 / 3.0));
}

TEST(MotionModel, OdometryErrorsAddUpWhereNoScanHelps) {
  const FrontendParams params;
  MotionModel model(params);
  const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
  model.start({0.0, still}, still);
  for (int step = 1; step <= 8; ++step) model.update({0.1 * step, still}, still, Matrix6d::Zero());
  // The ninth step of independent errors: √9 = 3 times that of one.
  EXPECT_NEAR(sigma(model.predict(0.9, still), 4), 3.0 * params.odometry_noise_translation, 1e-9);
  EXPECT_NEAR(sigma(model.predict(0.9, still), 0), 3.0 * params.odometry_noise_rotation, 1e-9);
}

TEST(MotionModel, FollowsOdometryWhereThereIsSome) {
  test::Random random(3);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d map_from_body = random.pose(3.0), odom_from_body = random.pose(3.0);
    const Eigen::Isometry3d step = random.motion(0.5, 0.5);
    MotionModel model(FrontendParams{});
    model.start({0.0, map_from_body}, odom_from_body);
    const PosePrior prior = model.predict(0.1, odom_from_body * step);
    EXPECT_TRUE(prior.map_from_body.isApprox(map_from_body * step, 1e-9));
  }
}

TEST(MotionModel, KeepsItsVelocityInTheBodyWhenTheMapMoves) {
  test::Random random(4);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d first = random.pose(3.0), second = first * random.motion(0.2, 0.2);
    const Eigen::Isometry3d new_from_old = random.pose(1.0);
    MotionModel model(FrontendParams{});
    model.start({0.0, first}, std::nullopt);
    model.update({0.1, second}, std::nullopt, exact());
    const Eigen::Isometry3d before = model.predict(0.2, std::nullopt).map_from_body;
    model.correct(new_from_old * second);
    const Eigen::Isometry3d after = model.predict(0.2, std::nullopt).map_from_body;
    EXPECT_TRUE(after.isApprox(new_from_old * before, 1e-9));
  }
}

TEST(MotionModel, TellsWhatMotionKnowsSinceAKeyframe) {
  const FrontendParams params;
  const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
  MotionModel model(params);
  model.start({0.0, still}, still);
  Eigen::Isometry3d odometry = still;
  odometry.translation().x() = 2.0;
  // Odometry: a ratio of the way. Without: any typical velocity, and accelerations over the time.
  const double of_odometry = std::hypot(params.odometry_noise_translation, 2.0 * 0.05);
  EXPECT_NEAR(model.informationSinceAnchor(1.0, odometry)(3, 3), std::pow(of_odometry, -2), 1e-9);
  const double of_velocity = std::hypot(params.speed, params.acceleration * std::sqrt(0.1 / 3.0));
  EXPECT_NEAR(model.informationSinceAnchor(1.0, std::nullopt)(3, 3), std::pow(of_velocity, -2),
              1e-9);
}

TEST(MotionModel, RelativeToTheLastPoseWhatWasOpenBeforeDoesNotCount) {
  FrontendParams params;
  params.least_unrest = 1.0;  // the densities below are of a typical body
  const double density = 0.1 * params.acceleration * params.acceleration;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    test::Random random(seed);
    Vector6d rate;
    rate << random.vector(0.3), random.vector(1.0);
    MotionModel model(params);
    model.start({0.0, Eigen::Isometry3d::Identity()}, std::nullopt);
    for (int step = 1; step <= 20; ++step) {
      const double time = 0.1 * step;
      const Matrix6d seen = step <= 15 ? exact() : Matrix6d(Matrix6d::Zero());
      model.update({time, moving(Eigen::Isometry3d::Identity(), rate, time)}, std::nullopt, seen);
    }
    MotionModel relative = model;
    relative.beginAtLastPose();
    const double later = random.uniform(0.05, 0.5);
    const MotionState all = model.predictState(2.0 + later, std::nullopt);
    const MotionState since = relative.predictState(2.0 + later, std::nullopt);
    EXPECT_EQ(since.map_from_body.matrix(), all.map_from_body.matrix());
    EXPECT_EQ(since.rate, all.rate);
    const double of_rate = model.state().covariance(9, 9);
    EXPECT_NEAR(since.covariance(3, 3),
                of_rate * later * later + density * later * later * later / 3.0, 1e-9);
    EXPECT_GT(all.covariance(3, 3), since.covariance(3, 3) + model.state().covariance(3, 3));
  }
}

/// Poses 0.2 s apart of a body whose velocities change at random by `share` of what a typical
/// body's do; what `see` says of each pose is known, the rest is as predicted.
template <typename See>
MotionModel afterRandomWalk(double share, int steps, const See& see, test::Random& random) {
  constexpr double kStep = 0.2;
  const FrontendParams params;
  MotionModel model(params);
  Eigen::Isometry3d pose = random.pose(2.0);
  Vector6d rate;
  rate << random.vector(0.2), random.vector(0.3);
  model.start({0.0, pose}, std::nullopt);
  for (int step = 1; step <= steps; ++step) {
    // White acceleration of density q: the rate changes by √(q t), the way by half of that at once.
    Vector6d change;
    for (int k = 0; k < 6; ++k)
      change[k] =
          random.normal(share * (k < 3 ? params.angular_acceleration : params.acceleration) *
                        std::sqrt(0.1 * kStep));
    pose = retract(pose, kStep * (rate + 0.5 * change));
    rate += change;
    model.update({kStep * step, pose}, std::nullopt, see(step));
  }
  return model;
}

/// A body at rest, seen so, that is taken to be a typical one whatever it does.
template <typename See>
MotionModel afterTypicalRest(int steps, const See& see) {
  FrontendParams params;
  params.least_unrest = 1.0;
  MotionModel model(params);
  model.start({0.0, Eigen::Isometry3d::Identity()}, std::nullopt);
  for (int step = 1; step <= steps; ++step)
    model.update({0.2 * step, Eigen::Isometry3d::Identity()}, std::nullopt, see(step));
  return model;
}

double sigmaAhead(const MotionModel& model, double time, int k) {
  return sigma(model.predict(time, std::nullopt), k);
}

TEST(MotionModel, LearnsHowCalmABodyIs) {
  const auto see_all = [](int) { return exact(); };
  const MotionModel typical = afterTypicalRest(100, see_all);
  test::Random random(7);
  for (const double share : {0.02, 0.1, 0.2, 1.0, 5.0}) {
    for (int walk = 0; walk < 20; ++walk) {
      const MotionModel model = afterRandomWalk(share, 100, see_all, random);
      const double expected = std::clamp(3.0 * share, 0.2, 1.0);  // caution, least and most
      for (const int k : {0, 3}) {
        const double learned = sigmaAhead(model, 20.5, k) / sigmaAhead(typical, 20.5, k);
        EXPECT_GT(learned, 0.5 * expected) << share;  // still above the truth, a third
        EXPECT_LT(learned, std::min(1.0 + 1e-9, 1.5 * expected)) << share;
      }
    }
  }
}

TEST(MotionModel, WhatNoScanFixesTeachesNothing) {
  // A bare wall: two turns and one shift are seen; where the body is along the wall is as
  // predicted.
  const auto see_wall = [](int) {
    Matrix6d seen = Matrix6d::Zero();
    seen.diagonal() << 0.0, 1e12, 1e12, 1e12, 0.0, 0.0;
    return seen;
  };
  test::Random random(8);
  const MotionModel model = afterRandomWalk(0.0, 30, see_wall, random);
  const MotionModel typical = afterTypicalRest(30, see_wall);
  EXPECT_NEAR(sigmaAhead(model, 6.5, 3), sigmaAhead(typical, 6.5, 3), 1e-9);
}

TEST(MotionModel, StampsThatDoNotAdvanceGiveFinitePredictions) {
  MotionModel model(FrontendParams{});
  model.start({5.0, Eigen::Isometry3d::Identity()}, std::nullopt);
  model.update({5.0, test::Random(5).pose(1.0)}, std::nullopt, Matrix6d::Zero());
  model.update({4.9, test::Random(6).pose(1.0)}, std::nullopt, exact());
  const PosePrior prior = model.predict(4.0, std::nullopt);
  EXPECT_TRUE(prior.map_from_body.matrix().allFinite());
  EXPECT_TRUE(prior.information.allFinite());
}

}  // namespace
}  // namespace opp::mapping
