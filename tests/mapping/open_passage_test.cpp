// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/open_passage.h"

#include "registration/observability.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
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

/// How a walk through a passage goes.
struct WalkOptions {
  FrontendParams params = calm();
  int scans_after = 4;
  /// After so many scans of the passage the body comes to keyframes, ascending.
  std::vector<int> keyframes = {kScansInPassage};
  /// What the scans fix relative to the keyframe before them: 1; else 0.
  Vector6d fixed = Vector6d::Zero();
};

/// A walk through a passage, from keyframe 0 on.
struct Walk {
  explicit Walk(std::uint64_t seed, const WalkOptions& walk_options = {})
      : options(walk_options), since_start(options.params), since_keyframe(options.params) {
    Walker walker(seed, options.params);
    since_start.start(walker.next(), std::nullopt);
    StampedPose last;
    for (int k = 0; k < 10; ++k) since_start.update(last = walker.next(), std::nullopt, exact());
    start_from_map = last.map_from_body.inverse();
    since_start.beginAtLastPose();
    passage.emplace();
    true_keyframe = last.map_from_body;
    addKeyframe();
    for (int k = 1; k <= kScansInPassage; ++k)
      pass(walker.next(), std::count(options.keyframes.begin(), options.keyframes.end(), k) > 0);
    const Eigen::Isometry3d end_from_map = true_poses.back().inverse() * start_from_map;
    for (int k = 0; k < options.scans_after; ++k) {
      const StampedPose later = walker.next();
      after.push_back({later.timestamp, end_from_map * later.map_from_body});
    }
    follow(*passage);
  }

  /// Tells another passage of the scans after this one.
  void follow(OpenPassage& other) const {
    for (const StampedPose& later : after) other.follow(later, exact());
  }

  Matrix6d predictedCovariance() const { return predicted.covariance.topLeftCorner<6, 6>(); }
  PosePrior tied() const { return {predicted.map_from_body, predictedCovariance().inverse()}; }

  WalkOptions options;
  MotionModel since_start, since_keyframe;
  Eigen::Isometry3d start_from_map;
  Eigen::Isometry3d true_keyframe;  ///< map_from_body of the last one
  MapState map;           ///< keyframes where motion predicts them, in the frame of the first one
  MotionState predicted;  ///< at the end, if nothing is fixed
  std::vector<Eigen::Isometry3d> true_poses;  ///< of the scans in the passage
  std::vector<StampedPose> after;
  std::optional<OpenPassage> passage;
  MotionState begins;                      ///< at the last keyframe
  std::vector<PassedScan> open;            ///< since the last keyframe
  std::optional<MotionModel> before_last;  ///< since that keyframe, before the last scan
  double last_time = 0.0;                  ///< of that

 private:
  /// At the last pose.
  void addKeyframe() {
    Keyframe keyframe;
    keyframe.map_from_body = start_from_map * since_start.state().map_from_body;
    map.keyframes.push_back(keyframe);
    since_keyframe = since_start;
    since_keyframe.beginAtLastPose();
    const MotionState& state = since_keyframe.state();
    begins = inFrame(state.map_from_body.inverse(), state);
  }

  /// What a scan finds: the truth relative to the last keyframe where it is fixed.
  StampedPose seen(const StampedPose& truth) const {
    const Eigen::Isometry3d map_from_previous =
        start_from_map.inverse() * map.keyframes.back().map_from_body;
    const Eigen::Isometry3d expected =
        map_from_previous.inverse() *
        since_start.predictState(truth.timestamp, std::nullopt).map_from_body;
    const Vector6d off = difference(expected, true_keyframe.inverse() * truth.map_from_body);
    return {truth.timestamp,
            map_from_previous * retract(expected, options.fixed.cwiseProduct(off))};
  }

  void pass(const StampedPose& truth, bool is_keyframe) {
    true_poses.push_back(start_from_map * truth.map_from_body);
    const Eigen::Isometry3d previous_from_map =
        map.keyframes.back().map_from_body.inverse() * start_from_map;
    const StampedPose found = seen(truth);
    const Matrix6d information =
        informationIn(previous_from_map.linear(), 1e10 * Matrix6d(options.fixed.asDiagonal()));
    before_last = since_keyframe;
    last_time = truth.timestamp;
    predicted =
        inFrame(start_from_map, since_start.update(found, std::nullopt, information).predicted);
    open.push_back(
        {map.scans.size(),
         inFrame(previous_from_map, since_keyframe.update(found, std::nullopt, information))});
    const auto before = static_cast<int>(map.keyframes.size()) - 1;
    const MotionState& since_previous = open.back().step.predicted;
    LocalizedScan scan;
    scan.keyframe = is_keyframe ? before + 1 : before;
    if (!is_keyframe) scan.keyframe_from_body = open.back().step.found.map_from_body;
    map.scans.push_back(scan);
    if (!is_keyframe) return;
    const PosePrior tie = {since_previous.map_from_body,
                           since_previous.covariance.topLeftCorner<6, 6>().inverse()};
    map.factors.relative_poses.push_back(
        {before, before + 1, tie.map_from_body, tie.information, false});
    passage->reach({before + 1, truth.timestamp, tie, begins, open});
    open.clear();
    true_keyframe = truth.map_from_body;
    addKeyframe();
  }
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
    const Walk walk(static_cast<std::uint64_t>(seed), {params});
    const PosePrior both = walk.passage->smoothed(params);
    errors.squared_sigmas += both.squaredSigmas(walk.true_poses.back()) / walks;
    errors.squared += difference(both.map_from_body, walk.true_poses.back()).squaredNorm();
    errors.squared_of_prediction +=
        difference(walk.predicted.map_from_body, walk.true_poses.back()).squaredNorm();
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
  MapState map = walk.map;
  map.factors.relative_poses.front().information += points;
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
  EXPECT_FALSE(Walk(3, {calm(), 0}).passage->isFollowed());
  EXPECT_TRUE(Walk(3).passage->isFollowed());
  Walk walk(3, {calm(), 0});
  MapState map = mapWithTie(walk, Matrix6d::Zero());
  walk.passage->tighten(calm(), map);
  const RelativePoseFactor& tie = map.factors.relative_poses.front();
  EXPECT_TRUE(tie.information.isApprox(walk.tied().information, 1e-9));
  EXPECT_LT(difference(tie.first_from_second, walk.predicted.map_from_body).norm(), 1e-9);
}

TEST(OpenPassage, WhatItSaidBeforeIsReplaced) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Walk at_once(seed), step_by_step(seed, {calm(), 0}), all(seed);
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
  const Matrix6d before = map.factors.relative_poses.front().information;
  walk.passage->tighten(calm(), map);
  EXPECT_EQ(map.factors.relative_poses.front().information, before);
}

/// A body that turns so little in the passage that linearization leaves out nothing.
FrontendParams steady() {
  FrontendParams params;
  params.angular_acceleration = 0.1;
  return params;
}

TEST(OpenPassage, KeyframesOnTheWayMakeTheWholeNoMoreCertain) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Walk whole(seed, {steady()}), by_keyframes(seed, {steady(), 4, {2, 3, kScansInPassage}});
    const PosePrior expected = whole.passage->smoothed(steady());
    const PosePrior smoothed = by_keyframes.passage->smoothed(steady());
    EXPECT_TRUE(smoothed.information.isApprox(expected.information, 0.05)) << "seed " << seed;
    by_keyframes.passage->tighten(steady(), by_keyframes.map);
    Eigen::Isometry3d start_from_end = Eigen::Isometry3d::Identity();
    Matrix6d covariance = Matrix6d::Zero();
    for (const RelativePoseFactor& tie : by_keyframes.map.factors.relative_poses) {
      const Matrix6d turn = turned(start_from_end.linear());
      const Eigen::Vector3d step = start_from_end.linear() * tie.first_from_second.translation();
      covariance = movedBy(step) * covariance * movedBy(step).transpose() +
                   turn * tie.information.inverse() * turn.transpose();
      start_from_end = start_from_end * tie.first_from_second;
    }
    const Matrix6d whole_covariance = smoothed.information.inverse();
    for (const int kind : {0, 3}) {
      const double share = covariance.block<3, 3>(kind, kind).trace() /
                           whole_covariance.block<3, 3>(kind, kind).trace();
      EXPECT_GT(share, 0.99) << "seed " << seed;
      EXPECT_LT(share, 1.2) << "seed " << seed;
    }
    EXPECT_LT(difference(start_from_end, expected.map_from_body).norm(), 2e-3) << "seed " << seed;
  }
}

TEST(OpenPassage, KeyframesOnTheWayThatFixSomeDirectionsMakeTheOthersNoMoreCertain) {
  constexpr int kWalks = 300;
  WalkOptions options;
  options.params = steady();
  options.keyframes = {2, 4, kScansInPassage};
  options.fixed << 1.0, 1.0, 0.0, 1.0, 0.0, 0.0;  // a wall that the body faces
  double sum = 0.0, variance = 0.0, variance_of_hidden = 0.0;
  for (int seed = 1; seed <= kWalks; ++seed) {
    const Walk walk(static_cast<std::uint64_t>(seed), options);
    const PosePrior smoothed = walk.passage->smoothed(steady());
    sum += smoothed.squaredSigmas(walk.true_poses.back());
    variance += smoothed.information.inverse()(4, 4);
    const Walk hidden(static_cast<std::uint64_t>(seed), {steady()});
    variance_of_hidden += hidden.passage->smoothed(steady()).information.inverse()(4, 4);
  }
  EXPECT_NEAR(sum / kWalks, 6.0, 0.6);
  EXPECT_GT(variance, 0.9 * variance_of_hidden);
}

/// Mean squared sigmas of the scans of the passage that are no keyframes. \param is_end_known
/// the last keyframe is where it truly was
double squaredSigmasOfScans(int walks, const FrontendParams& params, bool is_end_known) {
  double sum = 0.0;
  for (int seed = 1; seed <= walks; ++seed) {
    Walk walk(static_cast<std::uint64_t>(seed), {params});
    walk.passage->tighten(params, walk.map);
    walk.map.keyframes.back().map_from_body =
        is_end_known ? walk.true_poses.back() : walk.map.scans.front().open->keyframe_from_next;
    for (int k = 0; k + 1 < kScansInPassage; ++k) {
      const auto index = static_cast<std::size_t>(k);
      const LocalizedScan& scan = walk.map.scans[index];
      const Matrix6d& covariance =
          is_end_known ? scan.open->covariance_between : scan.open->covariance;
      sum += PosePrior{poseOf(walk.map, scan), covariance.inverse()}.squaredSigmas(
          walk.true_poses[index]);
    }
  }
  return sum / (walks * (kScansInPassage - 1));
}

TEST(OpenPassage, ScansOnTheWayAreAsFarOffAsTheyAreSaidToBe) {
  EXPECT_NEAR(squaredSigmasOfScans(300, calm(), false), 6.0, 0.6);
  // Turns of 0.2 rad that only the end tells of are beyond linearization.
  EXPECT_NEAR(squaredSigmasOfScans(300, steady(), true), 6.0, 0.6);
  EXPECT_LT(squaredSigmasOfScans(300, calm(), true), 8.0);
}

TEST(OpenPassage, ScansOnTheWayAreBestKnownBetweenKnownEnds) {
  Walk walk(5);
  walk.passage->tighten(calm(), walk.map);
  for (int k = 0; k + 1 < kScansInPassage; ++k) {
    const OpenPose& open = *walk.map.scans[static_cast<std::size_t>(k)].open;
    EXPECT_EQ(open.next, 1);
    EXPECT_LT(open.covariance_between.trace(), open.covariance.trace());
    EXPECT_GT(open.covariance.trace(), 0.0);
  }
}

TEST(OpenPassage, AScanFollowsTheKeyframeAfterItAsFarAsItIsNearIt) {
  Walk walk(6);
  walk.passage->tighten(calm(), walk.map);
  const auto yOf = [&](int scan) {
    return poseOf(walk.map, walk.map.scans[static_cast<std::size_t>(scan)]).translation().y();
  };
  std::vector<double> before;
  for (int k = 0; k < kScansInPassage; ++k) before.push_back(yOf(k));
  constexpr double kShift = 0.01;
  walk.map.keyframes.back().map_from_body.translation().y() += kShift;
  double last = 0.0;
  for (int k = 0; k < kScansInPassage; ++k) {
    const double moved = yOf(k) - before[static_cast<std::size_t>(k)];
    EXPECT_GT(moved, last);
    EXPECT_LE(moved, 1.001 * kShift);
    last = moved;
  }
}

TEST(SettlePassed, ScansAreSmoothedFromWhereThePoseIsKnownAgain) {
  constexpr int kWalks = 300;
  double sum = 0.0;
  for (int seed = 1; seed <= kWalks; ++seed) {
    // The last scan sees the start again.
    Walk walk(static_cast<std::uint64_t>(seed), {calm(), 0, {}});
    std::vector<PassedScan> scans = walk.open;
    PassedScan known = scans.back();
    scans.pop_back();
    MotionModel motion = *walk.before_last;
    known.step = inFrame(
        walk.start_from_map,
        motion.update({walk.last_time, walk.start_from_map.inverse() * walk.true_poses.back()},
                      std::nullopt, exact()));
    settlePassed(scans, known, walk.map);
    for (std::size_t k = 0; k < scans.size(); ++k) {
      const LocalizedScan& scan = walk.map.scans[k];
      EXPECT_EQ(scan.open->next, -1);
      sum += PosePrior{poseOf(walk.map, scan), scan.open->covariance.inverse()}.squaredSigmas(
          walk.true_poses[k]);
    }
  }
  EXPECT_NEAR(sum / (kWalks * (kScansInPassage - 1)), 6.0, 0.6);
}

}  // namespace
}  // namespace opp::mapping
