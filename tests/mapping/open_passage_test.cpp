// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/open_passage.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

namespace opp::mapping {
namespace {

/// What a body does between two moments that a simulation tells apart [s].
constexpr double kStep = 0.005;
/// Scans come so often [s].
constexpr int kStepsPerScan = 30;
/// A passage of 0.9 s.
constexpr int kScansInPassage = 6;

Matrix6d exact() { return 1e12 * Matrix6d::Identity(); }

/// A body that turns no faster than motion past a bare wall can be told.
FrontendParams calm() {
  FrontendParams params;
  params.angular_acceleration = 1.0;
  return params;
}

/// A body that moves by white accelerations, as MotionModel has it.
class Walker {
 public:
  Walker(std::uint64_t seed, const FrontendParams& params)
      : random_(seed), params_(params), pose_(random_.pose(2.0)) {
    rate_ << random_.vector(0.3), random_.vector(0.5);
  }

  /// Pose at the next scan.
  StampedPose next() {
    for (int k = 0; k < kStepsPerScan; ++k) {
      // Spectral density a²·0.1 s.
      const double scale = std::sqrt(0.1 * kStep);
      Vector6d change;
      for (int i = 0; i < 6; ++i)
        change[i] =
            scale * random_.normal(i < 3 ? params_.angular_acceleration : params_.acceleration);
      pose_ = retract(pose_, kStep * (rate_ + 0.5 * change));
      rate_ += change;
      time_ += kStep;
    }
    return {time_, pose_};
  }

 private:
  test::Random random_;
  FrontendParams params_;
  Eigen::Isometry3d pose_;
  Vector6d rate_;
  double time_ = 0.0;
};

/// A walk through a passage that hides all six directions.
struct Walk {
  explicit Walk(std::uint64_t seed, const FrontendParams& params = calm(), int scans_after = 4) {
    Walker walker(seed, params);
    MotionModel motion(params);
    motion.start(walker.next(), std::nullopt);
    StampedPose last;
    for (int k = 0; k < 10; ++k) motion.update(last = walker.next(), std::nullopt, exact());
    StampedPose end;
    for (int k = 0; k < kScansInPassage; ++k) end = walker.next();
    const Eigen::Isometry3d first_from_map = last.map_from_body.inverse();
    predicted = inFrame(first_from_map, motion.predictState(end.timestamp, std::nullopt));
    true_pose = first_from_map * end.map_from_body;
    passage.emplace(1, end.timestamp, predicted, tied());
    for (int k = 0; k < scans_after; ++k) {
      const StampedPose later = walker.next();
      after.push_back({later.timestamp, end.map_from_body.inverse() * later.map_from_body});
    }
    follow(*passage);
  }

  /// Tells another passage of the scans after this one.
  void follow(OpenPassage& other) const {
    for (const StampedPose& later : after) other.follow(later, exact());
  }

  Matrix6d predictedCovariance() const { return predicted.covariance.topLeftCorner<6, 6>(); }
  PosePrior tied() const { return {predicted.map_from_body, predictedCovariance().inverse()}; }

  MotionState predicted;
  Eigen::Isometry3d true_pose;
  std::vector<StampedPose> after;
  std::optional<OpenPassage> passage;
};

TEST(OpenPassage, TwoVelocitiesLeaveAboutAQuarterOfTheVariance) {
  const Walk walk(1);
  const Matrix6d before = walk.predictedCovariance();
  const Matrix6d after = walk.passage->smoothed(calm()).information.inverse();
  // About: neither velocity is known exactly.
  for (int k = 0; k < 6; ++k) {
    EXPECT_GT(after(k, k), 0.2 * before(k, k));
    EXPECT_LT(after(k, k), 0.35 * before(k, k));
  }
}

struct Errors {
  double squared_sigmas = 0.0;  ///< mean
  double squared = 0.0;
  double squared_of_prediction = 0.0;
};

Errors errorsOf(int walks, const FrontendParams& params) {
  Errors errors;
  for (int seed = 1; seed <= walks; ++seed) {
    const Walk walk(static_cast<std::uint64_t>(seed), params);
    const PosePrior both = walk.passage->smoothed(params);
    errors.squared_sigmas += both.squaredSigmas(walk.true_pose) / walks;
    errors.squared += difference(both.map_from_body, walk.true_pose).squaredNorm();
    errors.squared_of_prediction +=
        difference(walk.predicted.map_from_body, walk.true_pose).squaredNorm();
  }
  return errors;
}

TEST(OpenPassage, ErrorsAreAsLargeAsTheyAreSaidToBe) {
  const Errors errors = errorsOf(500, calm());
  EXPECT_NEAR(errors.squared_sigmas, 6.0, 0.6);
  EXPECT_LT(errors.squared, 0.4 * errors.squared_of_prediction);
}

TEST(OpenPassage, ABodyThatMayHaveTurnedFarOnItsWayIsNoMoreCertainThanItShouldBe) {
  // The prediction of its rotation is open by 0.8 rad.
  const Errors errors = errorsOf(500, FrontendParams());
  EXPECT_LT(errors.squared_sigmas, 8.0);
}

MapState mapWithTie(const Walk& walk, const Matrix6d& points) {
  MapState map;
  map.factors.relative_poses.push_back(
      {0, 1, walk.predicted.map_from_body, points + walk.tied().information, false});
  return map;
}

TEST(OpenPassage, TightensItsTieWhereMotionAloneTies) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Walk walk(seed);
    Matrix6d points = Matrix6d::Zero();
    points(1, 1) = points(5, 5) = 1e12;
    MapState map = mapWithTie(walk, points);
    walk.passage->tighten(calm(), map);
    const RelativePoseFactor& tie = map.factors.relative_poses.front();
    const PosePrior both = walk.passage->smoothed(calm());
    EXPECT_TRUE(tie.information.isApprox(points + both.information, 1e-9));
    const Vector6d moved = difference(walk.predicted.map_from_body, tie.first_from_second);
    EXPECT_NEAR(moved[1], 0.0, 1e-6);
    EXPECT_NEAR(moved[5], 0.0, 1e-6);
    Walk again(seed);
    MapState free = mapWithTie(again, Matrix6d::Zero());
    again.passage->tighten(calm(), free);
    EXPECT_LT(difference(free.factors.relative_poses.front().first_from_second, both.map_from_body)
                  .norm(),
              1e-6);
  }
}

TEST(OpenPassage, UntilAScanFollowsMotionBeforeIsAllThereIs) {
  EXPECT_FALSE(Walk(3, calm(), 0).passage->isFollowed());
  EXPECT_TRUE(Walk(3).passage->isFollowed());
  Walk walk(3, calm(), 0);
  MapState map = mapWithTie(walk, Matrix6d::Zero());
  walk.passage->tighten(calm(), map);
  const RelativePoseFactor& tie = map.factors.relative_poses.front();
  EXPECT_TRUE(tie.information.isApprox(walk.tied().information, 1e-9));
  EXPECT_LT(difference(tie.first_from_second, walk.predicted.map_from_body).norm(), 1e-9);
}

TEST(OpenPassage, WhatItSaidBeforeIsReplaced) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Walk at_once(seed), step_by_step(seed, calm(), 0), all(seed);
    Matrix6d points = Matrix6d::Zero();
    points.diagonal() << 1e3, 1e5, 1e2, 1e3, 1e4, 1e6;
    MapState expected = mapWithTie(at_once, points), map = expected;
    at_once.passage->tighten(calm(), expected);
    step_by_step.passage->tighten(calm(), map);
    all.follow(*step_by_step.passage);
    step_by_step.passage->tighten(calm(), map);
    const RelativePoseFactor& tie = map.factors.relative_poses.front();
    const RelativePoseFactor& wanted = expected.factors.relative_poses.front();
    EXPECT_TRUE(tie.information.isApprox(wanted.information, 1e-9)) << "seed " << seed;
    EXPECT_LT(difference(tie.first_from_second, wanted.first_from_second).norm(), 1e-4)
        << "to the second order; seed " << seed;
  }
}

TEST(OpenPassage, LeavesLoopsAlone) {
  Walk walk(4);
  MapState map = mapWithTie(walk, Matrix6d::Zero());
  map.factors.relative_poses.front().is_loop = true;
  walk.passage->tighten(calm(), map);
  EXPECT_EQ(map.factors.relative_poses.front().information, walk.tied().information);
}

}  // namespace
}  // namespace opp::mapping
