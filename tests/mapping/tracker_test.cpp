// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/tracker.h"

#include "opp/mapping/core/se3.h"
#include "opp/mapping/frontend/build_local_map.h"
#include "opp/mapping/frontend/insert_keyframe.h"

#include "support/random.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

constexpr double kTimeStep = test::kTimeStep;

Eigen::Isometry3d poseAt(double yaw, double x) {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(x, 0.1, 1.2);
  return pose;
}

/// A map of one keyframe and a tracker that starts there.
struct Started {
  MapState map;
  Tracker tracker{MapperParams()};
};

Started startWith(ScanFeatures scan, const Eigen::Isometry3d& pose,
                  const std::optional<Eigen::Isometry3d>& odometry = std::nullopt) {
  Started started;
  MatchResult match;
  match.map_from_body = pose;
  insertKeyframe(std::move(scan), match, SensorModel(), started.map);
  started.tracker.start({0.0, pose}, odometry);
  started.tracker.setLocalMap(localMapOf(started.map, {0}, MapperParams()));
  return started;
}

Started startAt(std::uint64_t room, const Eigen::Isometry3d& pose) {
  return startWith(test::scanOfRoom(room, 0, pose), pose);
}

TEST(Tracker, WithoutAMapNothingIsLocalized) {
  Tracker tracker{MapperParams()};
  const TrackResult result =
      tracker.track(test::scanOfRoom(1, 0, poseAt(0.0, 0.0)), std::nullopt, {});
  EXPECT_EQ(result.outcome, TrackOutcome::kNoMap);
  EXPECT_FALSE(result.localized());
  EXPECT_FALSE(result.wants_keyframe);
}

TEST(Tracker, SaysThatAScanIsEmpty) {
  Started started = startAt(1, poseAt(0.0, 0.0));
  EXPECT_EQ(started.tracker.track({}, std::nullopt, started.map).outcome, TrackOutcome::kEmptyScan);
}

TEST(Tracker, LocalizesTheNextScanInManyRooms) {
  for (std::uint64_t room = 0; room < 50; ++room) {
    Started started = startAt(room, poseAt(0.0, 0.0));
    const Eigen::Isometry3d truth = poseAt(0.05, 0.06);
    const TrackResult result =
        started.tracker.track(test::scanOfRoom(room, 1, truth), std::nullopt, started.map);
    ASSERT_TRUE(result.localized()) << "room " << room;
    EXPECT_FALSE(result.wants_keyframe) << "room " << room;
    const Vector6d error = difference(truth, result.match.map_from_body);
    // As in MatchScan: 4·3 mm·√2/√250 = 1.1 mm in each of three directions, rounded up.
    EXPECT_LT(error.head<3>().norm(), 2e-3) << "room " << room;
    EXPECT_LT(error.tail<3>().norm(), 2e-3) << "room " << room;
  }
}

TEST(Tracker, WantsAKeyframeOnceTheBodyLooksElsewhere) {
  Started started = startAt(2, poseAt(0.0, 0.0));
  bool wanted = false;
  for (int step = 1; step <= 4; ++step) {
    const TrackResult result = started.tracker.track(
        test::scanOfRoom(2, step, poseAt(0.12 * step, 0.0)), std::nullopt, started.map);
    ASSERT_TRUE(result.localized());
    // keyframe_rotation is 25° = 0.436 rad: passed at the fourth step.
    EXPECT_EQ(result.wants_keyframe, step == 4);
    wanted = wanted || result.wants_keyframe;
  }
  EXPECT_TRUE(wanted);
}

TEST(Tracker, AScanOfAnotherPlaceIsLostAndHarmless) {
  Started started = startAt(3, poseAt(0.0, 0.0));
  // One small sphere of outward normals agrees with no room.
  ScanFeatures elsewhere = test::scanOfRoom(3, 1, poseAt(0.0, 0.0));
  test::Random random(1);
  for (std::size_t i = 0; i < elsewhere.cloud_in_body.size(); ++i) {
    elsewhere.cloud_in_body.normals[i] = random.unitVector().cast<float>();
    elsewhere.cloud_in_body.points[i] = 0.3F * elsewhere.cloud_in_body.normals[i];
    elsewhere.primitives_in_body.labels[i] = -1;
  }
  Primitives none;
  none.labels = elsewhere.primitives_in_body.labels;
  elsewhere.primitives_in_body = none;
  EXPECT_EQ(started.tracker.track(elsewhere, std::nullopt, started.map).outcome,
            TrackOutcome::kLittleOverlap);
  EXPECT_TRUE(
      started.tracker.track(test::scanOfRoom(3, 2, poseAt(0.05, 0.0)), std::nullopt, started.map)
          .localized());
}

TEST(Tracker, ExpectsABodyThatSawNothingButNotOneThatWasMoved) {
  int lost = 0;
  for (std::uint64_t room = 0; room < 20; ++room) {
    const Eigen::Isometry3d pose = poseAt(0.0, 0.0);
    Started blind = startAt(room, pose);
    blind.tracker.track(ScanFeatures(), std::nullopt, blind.map);
    const auto expected = blind.tracker.expected(3.0 * kTimeStep, std::nullopt);
    ASSERT_TRUE(expected);
    EXPECT_LT(difference(pose, expected->map_from_body).norm(), 1e-9) << "it stood still";

    Started moved = startAt(room, pose);
    const ScanFeatures elsewhere = test::scanOfRoom(room + 20, 1, poseAt(2.5, 0.8));
    if (moved.tracker.track(elsewhere, std::nullopt, moved.map).localized()) continue;
    ++lost;
    EXPECT_FALSE(moved.tracker.expected(3.0 * kTimeStep, std::nullopt)) << "room " << room;
  }
  EXPECT_GT(lost, 10);
}

TEST(Tracker, FollowsAMapThatMoved) {
  Started started = startAt(4, poseAt(0.0, 0.0));
  Eigen::Isometry3d new_from_old(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));
  new_from_old.translation() = Eigen::Vector3d(5.0, -3.0, 0.5);
  Keyframe& keyframe = started.map.keyframes.front();
  keyframe.map_from_body = new_from_old * keyframe.map_from_body;
  for (PlaneLandmark& landmark : started.map.landmarks.planes)
    landmark.plane_in_map = transformed(new_from_old, landmark.plane_in_map);
  started.tracker.setLocalMap(localMapOf(started.map, {0}, MapperParams()));
  started.tracker.correct(keyframe.map_from_body);
  const Eigen::Isometry3d truth = poseAt(0.05, 0.06);
  const TrackResult result =
      started.tracker.track(test::scanOfRoom(4, 1, truth), std::nullopt, started.map);
  ASSERT_TRUE(result.localized());
  const Vector6d error = difference(new_from_old * truth, result.match.map_from_body);
  EXPECT_LT(error.head<3>().norm(), 2e-3);
  EXPECT_LT(error.tail<3>().norm(), 2e-3);
}

/// A wall as a body sees it that flies along it, `y` [m] from where it started.
ScanFeatures wallFrom(double y, double timestamp) {
  const test::Rectangles wall = {{{2.0, 0.0, 1.3}, {0.0, 0.0, 2.0}, {0.0, 4.0, 0.0}}};
  test::SyntheticOptions options;
  options.spacing = 0.08;
  options.sigma = 0.003;
  options.normal_sigma = 0.02;
  options.seed = static_cast<std::uint64_t>(1000.0 * timestamp);
  Eigen::Isometry3d scene_from_body = Eigen::Isometry3d::Identity();
  scene_from_body.translation() = Eigen::Vector3d(0.0, y, 1.2);
  ScanFeatures scan = test::trueFeatures(
      test::sampleScene(wall, scene_from_body.translation(), scene_from_body.inverse(), options));
  scan.timestamp = timestamp;
  return scan;
}

Eigen::Isometry3d beside(double y) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.0, y, 1.2);
  return pose;
}

Started startAtWall(const std::optional<Eigen::Isometry3d>& odometry) {
  return startWith(wallFrom(0.0, 0.0), beside(0.0), odometry);
}

TEST(Tracker, ABareWallEndsInLostWithoutOdometry) {
  Started started = startAtWall(std::nullopt);
  double sigma = 0.0;
  for (int step = 1; step <= 75; ++step) {
    const double time = 0.02 * step;
    const TrackResult result =
        started.tracker.track(wallFrom(0.5 * time, time), std::nullopt, started.map);
    if (!result.localized()) {
      EXPECT_EQ(result.outcome, TrackOutcome::kUnobserved);
      EXPECT_GT(step, 1);
      return;
    }
    // The way along the wall is known from nothing, and ever less.
    EXPECT_GT(std::sqrt(result.match.covariance(4, 4)), sigma);
    sigma = std::sqrt(result.match.covariance(4, 4));
  }
  FAIL() << "1.5 s without any sight of the way along the wall";
}

TEST(Tracker, FollowsABodyPastABareWallAndFindsTheWayOn) {
  const test::Rectangle wall = {{2.0, 0.0, 1.3}, {0.0, 0.0, 2.0}, {0.0, 4.0, 0.0}};
  const test::Rectangle floor = {{1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 4.0, 0.0}};
  const test::Rectangle side = {{1.0, 3.0, 1.3}, {0.0, 0.0, 2.0}, {-2.0, 0.0, 0.0}};
  const auto poseAfter = [](int step) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(0.02 * step, Eigen::Vector3d::UnitZ()));
    pose.translation() = Eigen::Vector3d(0.03 * step, 0.05 * step, 1.2);
    return pose;
  };
  const auto see = [&](const test::Rectangles& scene, int step) {
    return test::scanOfScene(scene, step, poseAfter(step));
  };
  Started started = startWith(see({wall, floor, side}, 0), poseAfter(0));
  int unobserved = 0;
  for (int step = 1; step <= 15; ++step) {
    const bool bare = step > 4 && step < 13;
    const TrackResult result = started.tracker.track(
        bare ? see({wall}, step) : see({wall, floor, side}, step), std::nullopt, started.map);
    const Vector6d error = difference(poseAfter(step), result.match.map_from_body);
    if (result.outcome == TrackOutcome::kUnobserved) {
      ++unobserved;
      EXPECT_TRUE(bare) << "step " << step;
      // What the wall shows is known all the time.
      EXPECT_NEAR(error[3], 0.0, 3e-3) << "step " << step;
      EXPECT_LT(error.segment<2>(1).norm(), 3e-3) << "step " << step;
      continue;
    }
    ASSERT_TRUE(result.localized()) << "step " << step << ": " << describe(result.outcome);
    if (bare) continue;
    EXPECT_LT(error.head<3>().norm(), 3e-3) << "step " << step;
    EXPECT_LT(error.tail<3>().norm(), 3e-3) << "step " << step;
  }
  EXPECT_GT(unobserved, 2);
}

TEST(Tracker, OncePositionIsForgottenNothingIsLookedFor) {
  Started started = startAt(1, poseAt(0.0, 0.0));
  for (int step = 1; step <= 3; ++step)
    EXPECT_TRUE(started.tracker
                    .track(test::scanOfRoom(1, step, poseAt(0.0, 0.0)), std::nullopt, started.map)
                    .localized());
  ScanFeatures later = test::scanOfRoom(1, 4, poseAt(0.0, 0.0));
  later.timestamp = 30.0;
  EXPECT_EQ(started.tracker.track(later, std::nullopt, started.map).outcome,
            TrackOutcome::kForgotten);
}

TEST(Tracker, ScansThatAreAlwaysFarApartAreNoGap) {
  constexpr double kSeconds = 4.0;
  int found = 0;
  for (std::uint64_t room = 0; room < 10; ++room) {
    Started started = startAt(room, poseAt(0.0, 0.0));
    for (int step = 1; step <= 3; ++step) {
      const Eigen::Isometry3d truth = poseAt(1.5 * step, 0.2 * step);
      ScanFeatures scan = test::scanOfRoom(room, step, truth);
      scan.timestamp = kSeconds * step;
      const TrackResult result = started.tracker.track(scan, std::nullopt, started.map);
      if (!result.localized()) continue;  // nothing is invented
      ++found;
      EXPECT_LT(difference(truth, result.match.map_from_body).norm(), 0.01) << "room " << room;
    }
    ScanFeatures later = test::scanOfRoom(room, 4, poseAt(0.0, 0.0));
    later.timestamp = 8.0 * kSeconds;
    EXPECT_EQ(started.tracker.track(later, std::nullopt, started.map).outcome,
              TrackOutcome::kForgotten)
        << "room " << room;
  }
  EXPECT_GE(found, 27);
}

/// After so long from rest a hand may hold a camera the other way round [s].
constexpr double kHalfTurn = 0.8;

TEST(Tracker, WhereMotionAllowsAHalfTurnAnAlignmentWithoutRivalsTellsThePose) {
  int found = 0;
  for (std::uint64_t room = 0; room < 20; ++room) {
    Started started = startAt(room, poseAt(0.0, 0.0));
    const Eigen::Isometry3d truth = poseAt(2.0, 0.3);
    ScanFeatures scan = test::scanOfRoom(room, 1, truth);
    scan.timestamp = kHalfTurn;
    const TrackResult result = started.tracker.track(scan, std::nullopt, started.map);
    if (!result.localized()) continue;  // nothing is invented
    ++found;
    EXPECT_LT(difference(truth, result.match.map_from_body).norm(), 0.01) << "room " << room;
  }
  EXPECT_GE(found, 18);
}

TEST(Tracker, WhereMotionAllowsAHalfTurnARoomThatIsTheSameThenTellsNothing) {
  const test::Rectangles room = test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5});
  for (int seed = 1; seed <= 5; ++seed) {
    const Eigen::Isometry3d start = poseAt(0.0, 0.0);
    Started started = startWith(test::scanOfScene(room, 100 + seed, start), start);
    ScanFeatures scan = test::scanOfScene(room, seed, poseAt(0.3, 0.2));
    scan.timestamp = kHalfTurn;
    EXPECT_FALSE(started.tracker.track(scan, std::nullopt, started.map).localized()) << seed;
  }
}

TEST(Tracker, OdometryCarriesABareWall) {
  Started started = startAtWall(beside(0.0));
  for (int step = 1; step <= 20; ++step) {
    const double time = 0.1 * step, y = 0.05 * step;
    const TrackResult result = started.tracker.track(wallFrom(y, time), beside(y), started.map);
    ASSERT_TRUE(result.localized()) << "step " << step << ": " << describe(result.outcome);
    const Vector6d error = difference(beside(y), result.match.map_from_body);
    EXPECT_LT(error.head<3>().norm(), 3e-3) << "step " << step;
    EXPECT_LT(error.tail<3>().norm(), 3e-3) << "step " << step;
    // Independent errors of 5 % of 5 cm and 2 mm a step.
    EXPECT_NEAR(std::sqrt(result.match.covariance(4, 4)), std::sqrt(step) * 3.2e-3, 1e-3);
  }
}

TEST(Tracker, WhatStandsWhereTheMapWasLookedThroughSpeaksAgainstAPose) {
  for (std::uint64_t room = 0; room < 5; ++room) {
    Started started = startAt(room, poseAt(0.0, 0.0));
    ScanFeatures scan = test::scanOfRoom(room, 1, poseAt(0.0, 0.0));
    test::Random random(room);
    for (std::size_t i = 0; i < scan.cloud_in_body.size(); ++i) {
      if (random.uniform(0.0, 1.0) < 0.45) continue;
      scan.cloud_in_body.points[i] *= 0.6F;  // far nearer to the sensor than the room
    }
    Primitives none;
    none.labels.assign(scan.cloud_in_body.size(), -1);
    scan.primitives_in_body = none;
    const TrackResult result = started.tracker.track(scan, std::nullopt, started.map);
    EXPECT_GT(result.match.overlap, FrontendParams().min_overlap) << "room " << room;
    EXPECT_EQ(result.outcome, TrackOutcome::kContradicted) << "room " << room;
  }
}

TEST(Tracker, DoesNotBelieveAJumpThatNoBodyMakes) {
  for (std::uint64_t room = 0; room < 5; ++room) {
    const Eigen::Isometry3d moved = poseAt(0.1, 0.4);
    ScanFeatures scan = test::scanOfRoom(room, 1, moved);
    scan.timestamp = 0.5;
    Started slow = startAt(room, poseAt(0.0, 0.0));
    const TrackResult walked = slow.tracker.track(scan, std::nullopt, slow.map);
    EXPECT_TRUE(walked.localized()) << "room " << room << ": " << describe(walked.outcome);
    scan.timestamp = 0.05;  // 8 m/s
    Started fast = startAt(room, poseAt(0.0, 0.0));
    const TrackResult jumped = fast.tracker.track(scan, std::nullopt, fast.map);
    EXPECT_FALSE(jumped.localized()) << "room " << room;
  }
}

TEST(Tracker, WhatMotionCallsImpossibleMustExplainMostOfTheScan) {
  for (std::uint64_t room = 0; room < 10; ++room) {
    for (const double shift : {0.0, 0.12}) {
      for (const double clutter : {0.0, 0.4, 0.5}) {
        Started started = startAt(room, poseAt(0.0, 0.0));
        for (int step = 1; step <= 5; ++step)
          started.tracker.track(test::scanOfRoom(room, step, poseAt(0.0, 0.0)), std::nullopt,
                                started.map);
        ScanFeatures scan = test::scanOfRoom(room, 6, poseAt(0.0, shift));
        test::Random random(room);
        // Off by some centimetres: too much to agree, too little to stand in free space.
        for (Eigen::Vector3f& point : scan.cloud_in_body.points) {
          if (random.uniform(0.0, 1.0) < clutter)
            point *= random.uniform(0.0, 1.0) < 0.5 ? 0.97F : 1.03F;
        }
        const TrackResult result = started.tracker.track(scan, std::nullopt, started.map);
        const double moved = result.match.map_from_body.translation().x();
        const bool found = result.localized() && std::abs(moved - shift) < 0.02;
        EXPECT_EQ(found, shift == 0.0 || clutter == 0.0)
            << "room " << room << " shift " << shift << " clutter " << clutter << ": "
            << describe(result.outcome) << ", overlap " << result.match.overlap;
      }
    }
  }
}

TEST(Tracker, FollowsAJerkOfLessThanASampleMayBeOff) {
  test::Random random(1);
  for (std::uint64_t room = 0; room < 10; ++room) {
    Started started = startAt(room, poseAt(0.0, 0.0));
    const auto see = [&](int step, const Eigen::Isometry3d& pose) {
      ScanFeatures scan = test::scanOfRoom(room, step, pose);
      scan.timestamp = step / 30.0;
      return scan;
    };
    for (int step = 1; step <= 5; ++step)
      started.tracker.track(see(step, poseAt(0.0, 0.0)), std::nullopt, started.map);
    const Eigen::Vector3d jerk = 0.025 * random.unitVector();
    Eigen::Isometry3d truth = poseAt(0.0, 0.0);
    truth.translation() += jerk;
    ScanFeatures scan = see(6, truth);
    // Samples of what has moved since, such that those which just agree do so without the jerk.
    OrientedCloud& cloud = scan.cloud_in_body;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3f normal = cloud.normals[i];
      const double along = jerk.dot((truth.linear() * normal.cast<double>()).eval());
      if (random.uniform(0.0, 1.0) > 0.15) continue;
      const double moved = cloud.spacing + random.uniform(0.0, 0.05);
      cloud.points[i] += static_cast<float>(std::copysign(moved, along)) * normal;
      scan.primitives_in_body.labels[i] = -1;
    }
    const TrackResult result = started.tracker.track(scan, std::nullopt, started.map);
    ASSERT_TRUE(result.localized()) << "room " << room << ": " << describe(result.outcome);
    EXPECT_LT(difference(truth, result.match.map_from_body).norm(), 5e-3) << "room " << room;
  }
}

TEST(Tracker, ABodyThatWasCarriedOffIsNotFoundByOneScan) {
  int surprised = 0;
  for (std::uint64_t room = 0; room < 6; ++room) {
    for (const double shift : {0.0, 0.12}) {
      Started started = startAt(room, poseAt(0.0, 0.0));
      for (int step = 1; step <= 5; ++step)
        started.tracker.track(test::scanOfRoom(room, step, poseAt(0.0, 0.0)), std::nullopt,
                              started.map);
      const ScanFeatures elsewhere = test::scanOfRoom(room + 20, 6, poseAt(2.5, 0.8));
      started.tracker.track(elsewhere, std::nullopt, started.map);
      if (started.tracker.expected(7.0 * kTimeStep, std::nullopt)) continue;  // not surprised
      ++surprised;
      const TrackResult after = started.tracker.track(
          test::scanOfRoom(room, 7, poseAt(shift, shift)), std::nullopt, started.map);
      EXPECT_EQ(after.localized(), shift == 0.0) << "room " << room << ": what hid the map passed";
    }
  }
  EXPECT_GE(surprised, 6);
}

TEST(Likeliest, IsThePoseThatMotionClearlySpeaksFor) {
  PosePrior prior;
  prior.information = Matrix6d::Identity();
  Eigen::Isometry3d near = Eigen::Isometry3d::Identity(), far = near, farther = near;
  near.translation().x() = 1.0;
  far.translation().x() = -3.0;
  farther.translation().x() = 4.0;
  EXPECT_FALSE(likeliest({}, prior).has_value());
  EXPECT_TRUE(likeliest({far}, prior)->isApprox(far));
  EXPECT_FALSE(likeliest({far, near}, prior).has_value());         // 9 − 1 < 9.2
  EXPECT_TRUE(likeliest({farther, near}, prior)->isApprox(near));  // 16 − 1
  EXPECT_FALSE(likeliest({farther, near, near}, prior).has_value());
  far.translation().x() = 100.0;
  EXPECT_FALSE(likeliest({far}, prior).has_value());
}

}  // namespace
}  // namespace opp::mapping
