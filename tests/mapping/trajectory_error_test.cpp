// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/trajectory_error.h"

#include "opp/geometry/constants.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace opp::mapping {
namespace {

/// A path without symmetry: a helix, `count` poses `step` seconds apart.
Trajectory helix(int count, double step = 0.1) {
  Trajectory path;
  for (int k = 0; k < count; ++k) {
    const double angle = 0.2 * k;
    StampedPose pose;
    pose.timestamp = step * k;
    pose.map_from_body.translation() =
        Eigen::Vector3d(2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.05 * k);
    pose.map_from_body.linear() =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    path.push_back(pose);
  }
  return path;
}

Eigen::Isometry3d turn(double angle, const Eigen::Vector3d& axis) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  return result;
}

void expectAll(const ErrorStatistics& s, double value, double tolerance) {
  for (const double found : {s.rmse, s.mean, s.median, s.p90, s.max}) {
    EXPECT_NEAR(found, value, tolerance);
  }
}

TEST(TrajectoryError, OfTheTruthAgainstItselfIsZero) {
  const TrajectoryError e = trajectoryError(helix(50), helix(50));
  EXPECT_EQ(e.matched, 50u);
  EXPECT_EQ(e.coverage, 1.0);
  for (const auto* s : {&e.ate_translation, &e.rpe_frame_translation, &e.rpe_metre_translation,
                        &e.ate_rotation, &e.rpe_frame_rotation, &e.rpe_metre_rotation}) {
    EXPECT_GT(s->count, 0u);
    EXPECT_LT(s->max, 1e-12);
  }
}

TEST(TrajectoryError, DoesNotSeeTheChoiceOfTheMapFrame) {
  test::Random random(71);
  for (int k = 0; k < 50; ++k) {
    const Trajectory gt = helix(30);
    Trajectory est = gt;
    const Eigen::Isometry3d est_from_gt = random.pose(20.0);
    for (auto& pose : est) pose.map_from_body = est_from_gt * pose.map_from_body;
    const TrajectoryError e = trajectoryError(gt, est);
    // Rounding, amplified by coordinates of 20 m.
    EXPECT_LT(e.ate_translation.max, 1e-11);
    EXPECT_LT(e.ate_rotation.max, 1e-11);
    EXPECT_LT((e.gt_from_est.matrix() - est_from_gt.inverse().matrix()).norm(), 1e-11);
  }
}

TEST(TrajectoryError, AlternatingOffsetIsTheAbsoluteErrorAndTwiceThatPerFrame) {
  // ±h along z by turns on a straight line along x with the signs + − − + repeated: no translation
  // and no tilt removes any of it (Σ s = 0, Σ s·x = 0).
  const double h = 0.03;
  Trajectory gt, est;
  const double signs[] = {1, -1, -1, 1};
  for (int k = 0; k < 8; ++k) {
    StampedPose pose;
    pose.timestamp = k;
    pose.map_from_body.translation() = Eigen::Vector3d(k, 0, 0);
    gt.push_back(pose);
    pose.map_from_body.translation().z() = h * signs[k % 4];
    est.push_back(pose);
  }
  const TrajectoryError e = trajectoryError(gt, est);
  expectAll(e.ate_translation, h, 1e-12);
  expectAll(e.ate_rotation, 0.0, 1e-12);
  // Steps: +−, −−, −+, ++, +−, −−, −+ : 2h, 0, 2h, 0, 2h, 0, 2h.
  EXPECT_EQ(e.rpe_frame_translation.count, 7u);
  EXPECT_NEAR(e.rpe_frame_translation.rmse, 2 * h * std::sqrt(4.0 / 7.0), 1e-12);
  EXPECT_NEAR(e.rpe_frame_translation.median, 2 * h, 1e-12);
  // The poses are 1 m apart, so the error per metre over 1 m is the same.
  EXPECT_NEAR(e.rpe_metre_translation.rmse, 2 * h * std::sqrt(4.0 / 7.0), 1e-12);
  EXPECT_NEAR(e.path_length, 7.0, 1e-12);
}

TEST(TrajectoryError, ConstantScaleErrorIsThatErrorPerMetre) {
  Trajectory gt, est;
  for (int k = 0; k <= 40; ++k) {
    StampedPose pose;
    pose.timestamp = 0.1 * k;
    pose.map_from_body.translation() = Eigen::Vector3d(0.25 * k, 0, 0);
    gt.push_back(pose);
    pose.map_from_body.translation() *= 1.02;
    est.push_back(pose);
  }
  const TrajectoryError e = trajectoryError(gt, est);
  expectAll(e.rpe_metre_translation, 0.02, 1e-12);
  EXPECT_EQ(e.rpe_metre_translation.count, 37u);  // from each pose that has a metre ahead of it
  expectAll(e.rpe_frame_translation, 0.25 * 0.02, 1e-12);
  EXPECT_NEAR(e.ate_translation.max, 5.0 * 0.02, 1e-12);  // about the centre of a 10 m path
}

TEST(TrajectoryError, BodyTurnedByAConstantIsARotationErrorOnly) {
  const double angle = degToRad(3.0);
  const Trajectory gt = helix(40);
  Trajectory est = gt;
  for (auto& pose : est) pose.map_from_body = pose.map_from_body * turn(angle, {0, 0, 1});
  const TrajectoryError e = trajectoryError(gt, est);
  // Orientations, 3° off, pull at the alignment with 1e-10 of the weight of the exact positions.
  expectAll(e.ate_rotation, angle, 1e-9);
  expectAll(e.ate_translation, 0.0, 1e-12);
}

TEST(TrajectoryError, ShortPathDoesNotMakeRotationErrors) {
  // 5 cm of path with 3 mm of noise, exact orientations: aligning the positions alone turns the
  // trajectory by degrees.
  test::Random random(73);
  Trajectory gt = helix(40);
  for (auto& pose : gt) pose.map_from_body.translation() *= 0.05 / 3.0;
  Trajectory est = gt;
  for (auto& pose : est) pose.map_from_body.translation() += random.vector(0.003);
  const TrajectoryError e = trajectoryError(gt, est);
  EXPECT_LT(e.ate_rotation.max, 1e-3);
  EXPECT_GT(e.ate_translation.rmse, 1e-3);
}

TEST(TrajectoryError, SteadyTurnIsTheRotationErrorPerFrame) {
  const double angle = 1e-3;
  const Trajectory gt = helix(40);
  Trajectory est = gt;
  for (std::size_t k = 1; k < gt.size(); ++k) {
    const Eigen::Isometry3d motion =
        gt[k - 1].map_from_body.inverse() * gt[k].map_from_body * turn(angle, {1, 0, 0});
    est[k].map_from_body = est[k - 1].map_from_body * motion;
  }
  expectAll(trajectoryError(gt, est).rpe_frame_rotation, angle, 1e-12);
  expectAll(trajectoryError(gt, est).rpe_frame_translation, 0.0, 1e-12);
}

TEST(TrajectoryError, OnePoseAlignsExactly) {
  test::Random random(72);
  const TrajectoryError e = trajectoryError({{1.0, random.pose(3.0)}}, {{1.0, random.pose(3.0)}});
  EXPECT_LT(e.ate_translation.max, 1e-12);
  EXPECT_LT(e.ate_rotation.max, 1e-7);  // the angle of a product of rotations near identity
  EXPECT_EQ(e.rpe_frame_translation.count, 0u);
  EXPECT_EQ(e.rpe_metre_translation.count, 0u);
  EXPECT_EQ(e.coverage, 1.0);
}

TEST(TrajectoryError, CoverageCountsMissingFramesAtTheSameRate) {
  const Trajectory gt = helix(100);
  Trajectory est = gt;
  est.erase(est.begin() + 40, est.begin() + 60);
  EXPECT_DOUBLE_EQ(trajectoryError(gt, est).coverage, 0.8);
}

TEST(TrajectoryError, CoverageIsFullWhereTheTruthHasAHigherRate) {
  const Trajectory gt = helix(1001, 0.01);
  Trajectory est;
  for (std::size_t k = 0; k <= 1000; k += 4) est.push_back(gt[k]);
  EXPECT_EQ(trajectoryError(gt, est).coverage, 1.0);
}

TEST(TrajectoryError, NothingToCompareIsAnError) {
  EXPECT_THROW(trajectoryError({}, helix(5)), std::invalid_argument);
  EXPECT_THROW(trajectoryError(helix(5), {}), std::invalid_argument);
  Trajectory later = helix(5);
  for (auto& pose : later) pose.timestamp += 100.0;
  EXPECT_THROW(trajectoryError(helix(5), later), std::invalid_argument);
}

TEST(TrajectoryError, PosesThatAreNotFiniteAreAnError) {
  Trajectory est = helix(5);
  est[2].map_from_body.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(trajectoryError(helix(5), est), std::invalid_argument);
  EXPECT_THROW(trajectoryError(est, helix(5)), std::invalid_argument);
  TrajectoryErrorParams params;
  params.rpe_distance = 0.0;
  EXPECT_THROW(trajectoryError(helix(5), helix(5), params), std::invalid_argument);
}

TEST(TrajectoryError, NoiseOfKnownSizeIsMeasuredAsThat) {
  // Isotropic noise of σ per axis on N positions: E[ATE²] = 3σ²(1 − 2/N), since the alignment takes
  // 6 of the 3N degrees of freedom. Over 50 runs of 100 poses the mean of ATE² scatters by
  // 3σ²·√(2/(3·100·50)) ≈ 1.2 % of it (one standard deviation); bound: four of them.
  test::Random random(73);
  const double sigma = 0.02;
  const int n = 100;
  double sum = 0.0;
  for (int run = 0; run < 50; ++run) {
    const Trajectory gt = helix(n);
    Trajectory est = gt;
    for (auto& pose : est) {
      const double x = random.normal(sigma);
      const double y = random.normal(sigma);
      pose.map_from_body.translation() += Eigen::Vector3d(x, y, random.normal(sigma));
    }
    sum += std::pow(trajectoryError(gt, est).ate_translation.rmse, 2) / 50;
  }
  const double expected = 3 * sigma * sigma * (1.0 - 2.0 / n);
  EXPECT_NEAR(sum, expected, 0.048 * expected);
}

}  // namespace
}  // namespace opp::mapping
