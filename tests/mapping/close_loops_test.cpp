// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/close_loops.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/core/se3.h"
#include "opp/mapping/frontend/insert_keyframe.h"
#include "opp/mapping/loop/close_loose_ties.h"

#include "support/random.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

Eigen::Isometry3d poseAt(int step) {
  const double phase = 0.3 * step;
  Eigen::Isometry3d pose(Eigen::AngleAxisd(phase, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(0.3 * std::cos(phase), 0.3 * std::sin(phase), 1.3);
  return pose;
}

/// Adds a keyframe of the room at the pose that tracking believes in, all its planes new landmarks
/// and tied to the keyframe before as odometry ties it.
void addKeyframe(std::uint64_t room, int step, const Eigen::Isometry3d& believed, double variance,
                 MapState& map) {
  test::SyntheticOptions options;
  options.spacing = 0.08;
  options.sigma = 0.003;
  options.seed = static_cast<std::uint64_t>(100 + step);
  MatchResult match;
  match.map_from_body = believed;
  match.point_information = Matrix6d::Identity() / variance;
  const Eigen::Isometry3d truth = poseAt(step);
  ScanFeatures scan = test::trueFeatures(
      test::sampleScene(test::furnishedRoom(room), truth.translation(), truth.inverse(), options));
  scan.scan_index = static_cast<std::size_t>(step);
  const int id = insertKeyframe(std::move(scan), match, SensorModel(), map);
  if (id > 0) map.links.push_back({id - 1, id, variance});
}

/// Two keyframes at the true pose, and then, after a way whose drift is given, some that come back.
MapState openLoop(std::uint64_t room, const Vector6d& drift, double sigma, int keyframes,
                  LoopCloser& closer, bool& closed) {
  MapState map;
  addKeyframe(room, 0, poseAt(0), 1e-6, map);
  addKeyframe(room, 1, poseAt(1), 1e-6, map);
  for (int k = 0; k < keyframes && !closed; ++k) {
    const int step = 2 + k;
    const Eigen::Isometry3d drifted = retract(Eigen::Isometry3d::Identity(), drift) * poseAt(step);
    addKeyframe(room, step, drifted, k == 0 ? sigma * sigma : 1e-6, map);
    closed = closer.close(map);
  }
  return map;
}

TEST(LoopCloser, UndoesTheDriftOnceTwoKeyframesAgree) {
  test::Random random(1);
  for (std::uint64_t room = 1; room <= 10; ++room) {
    Vector6d drift;
    drift << random.vector(0.02), random.vector(0.12);
    LoopCloser closer{MapperParams()};
    bool closed = false;
    const MapState map = openLoop(room, drift, 0.15, 4, closer, closed);
    ASSERT_TRUE(closed) << "room " << room;
    EXPECT_GE(map.keyframes.size(), 4U) << "one keyframe is no proof";
    EXPECT_EQ(map.loop_closures, 1U);
    for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
      const Vector6d error =
          difference(poseAt(static_cast<int>(k)), map.keyframes[k].map_from_body);
      EXPECT_LT(error.norm(), 5e-3) << "room " << room << " keyframe " << k;
    }
  }
}

TEST(LoopCloser, BelievesNothingBeyondTheDrift) {
  for (std::uint64_t room = 1; room <= 5; ++room) {
    Vector6d drift;
    drift << 0.0, 0.0, 0.0, 0.3, 0.2, 0.0;
    LoopCloser closer{MapperParams()};
    bool closed = false;
    // A way of a few millimetres of drift cannot have led so far off.
    openLoop(room, drift, 0.03, 4, closer, closed);
    EXPECT_FALSE(closed) << "room " << room;
  }
}

TEST(LoopCloser, IsNotTurnedAroundBySymmetry) {
  // A bare room looks the same turned around, with its middle where it was.
  Vector6d turned;
  turned << 0.0, 0.0, kPi, 0.0, 0.0, 0.0;
  MapState map;
  LoopCloser closer{MapperParams()};
  bool closed = false;
  for (int k = 0; k < 5; ++k) {
    const Eigen::Isometry3d truth = poseAt(k);
    test::SyntheticOptions options;
    options.spacing = 0.08;
    options.seed = static_cast<std::uint64_t>(k);
    MatchResult match;
    match.map_from_body = k < 2 ? truth : retract(Eigen::Isometry3d::Identity(), turned) * truth;
    match.point_information = 1e4 * Matrix6d::Identity();
    const auto room = test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5});
    ScanFeatures scan =
        test::trueFeatures(test::sampleScene(room, truth.translation(), truth.inverse(), options));
    scan.scan_index = static_cast<std::size_t>(k);
    const int id = insertKeyframe(std::move(scan), match, SensorModel(), map);
    if (id > 0) map.links.push_back({id - 1, id, id == 2 ? 0.04 : 1e-6});
    closed = closed || closer.close(map);
  }
  // The later keyframes are where the map has them, or half a turn off: the drift does not tell,
  // and a turn of half a circle is no drift.
  for (int k = 2; k < 5; ++k) {
    const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(k)];
    const Eigen::Isometry3d before = retract(Eigen::Isometry3d::Identity(), turned) * poseAt(k);
    EXPECT_LT(rotationAngle(before.inverse() * keyframe.map_from_body), 0.05) << "keyframe " << k;
  }
}

TEST(LoopCloser, LooksForNoLoopAmongKeyframesThatAreTied) {
  LoopCloser closer{MapperParams()};
  bool closed = false;
  const MapState map = openLoop(1, Vector6d::Zero(), 1e-3, 4, closer, closed);
  EXPECT_FALSE(closed);
  EXPECT_EQ(map.loop_closures, 0U);
}

/// Two keyframes at the true pose, and some that came back to the room after a way of loose ties.
MapState looseMap(std::uint64_t room, const Vector6d& drift, int keyframes) {
  MapState map;
  addKeyframe(room, 0, poseAt(0), 1e-6, map);
  addKeyframe(room, 1, poseAt(1), 1e-6, map);
  for (int k = 0; k < keyframes; ++k) {
    const int step = 2 + k;
    addKeyframe(room, step, retract(Eigen::Isometry3d::Identity(), drift) * poseAt(step),
                k == 0 ? 0.06 : 1e-6, map);
  }
  return map;
}

constexpr double kLooseVariance = 0.02;  // m²

TEST(CloseLooseTies, FindsWhatNoKeyframeLookedForAsTheMapGrew) {
  test::Random random(3);
  int closed = 0;
  for (std::uint64_t room = 1; room <= 20; ++room) {
    Vector6d drift;
    drift << random.vector(0.02), random.vector(0.2);
    MapState map = looseMap(room, drift, 3);
    if (closeLooseTies(kLooseVariance, MapperParams(), map) == 0) continue;
    ++closed;
    EXPECT_EQ(map.loop_closures, 1U);
    for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
      const Vector6d error =
          difference(poseAt(static_cast<int>(k)), map.keyframes[k].map_from_body);
      EXPECT_LT(error.norm(), 5e-3) << "room " << room << " keyframe " << k;
    }
  }
  EXPECT_GE(closed, 19);
}

TEST(CloseLooseTies, LeavesAsItIsWhatOneKeyframeAloneSaw) {
  for (std::uint64_t room = 1; room <= 10; ++room) {
    MapState map = looseMap(room, Vector6d::Constant(0.01), 1);
    const MapState before = map;
    EXPECT_EQ(closeLooseTies(kLooseVariance, MapperParams(), map), 0) << "room " << room;
    EXPECT_EQ(map.factors.relative_poses.size(), before.factors.relative_poses.size());
    for (std::size_t k = 0; k < before.keyframes.size(); ++k) {
      EXPECT_EQ(map.keyframes[k].map_from_body.matrix(),
                before.keyframes[k].map_from_body.matrix());
    }
  }
}

TEST(CloseLooseTies, HasNothingToDoWhereAllIsTied) {
  MapState map = looseMap(1, Vector6d::Zero(), 2);
  for (KeyframeLink& link : map.links) link.variance = 1e-6;
  EXPECT_EQ(closeLooseTies(kLooseVariance, MapperParams(), map), 0);
  MapState empty;
  EXPECT_EQ(closeLooseTies(kLooseVariance, MapperParams(), empty), 0);
}

TEST(AcceptClaims, TakesBackWhatTheRestOfTheMapDenies) {
  LoopCloser closer{MapperParams()};
  bool closed = false;
  MapState map = openLoop(2, Vector6d::Zero(), 1e-3, 3, closer, closed);
  const std::size_t factors = map.factors.relative_poses.size();
  const MapState before = map;
  std::vector<PlaceClaim> claims(2);
  for (int k = 0; k < 2; ++k) {
    PlaceClaim& claim = claims[static_cast<std::size_t>(k)];
    claim.keyframe_a = 0;
    claim.keyframe_b = 3 + k;
    // Two that contradict each other: one of the frames would have to be in two places.
    claim.keyframe_a_from_b =
        Eigen::Translation3d(k == 0 ? 1.0 : -1.0, 0.0, 0.0) * (poseAt(0).inverse() * poseAt(3 + k));
    claim.information = 1e4 * Matrix6d::Identity();
  }
  EXPECT_EQ(acceptClaims(claims, MapperParams(), map), 0);
  EXPECT_EQ(map.factors.relative_poses.size(), factors);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    EXPECT_EQ(map.keyframes[k].map_from_body.matrix(), before.keyframes[k].map_from_body.matrix());
    EXPECT_EQ(map.keyframes[k].landmark_of_plane, before.keyframes[k].landmark_of_plane);
  }
}

TEST(LinkKeyframe, ExpectsMoreDriftTheFartherViewsAreApart) {
  MapState map;
  for (int k = 0; k < 3; ++k) {
    map.keyframes.emplace_back();
    map.keyframes.back().map_from_body.translation().x() = k == 2 ? 0.0 : 4.0 * k;
  }
  const LoopParams params;
  linkKeyframe({0, 1}, Matrix6d::Zero(), params, map);
  ASSERT_EQ(map.links.size(), 2U);
  EXPECT_DOUBLE_EQ(map.links[0].variance, std::pow(params.step_sigma, 2));
  EXPECT_DOUBLE_EQ(map.links[1].variance,
                   std::pow(params.step_sigma, 2) + std::pow(4.0 * params.drift_ratio, 2));
  EXPECT_EQ(map.links[1].second, 2);
}

TEST(LinkKeyframe, CarriesWhatTheMatchLeftOpen) {
  MapState map;
  map.keyframes.resize(2);
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << 0.0, 1e-4, 0.0, 0.0, 0.0, 0.09;
  const LoopParams params;
  linkKeyframe({0}, covariance, params, map);
  ASSERT_EQ(map.links.size(), 1U);
  EXPECT_NEAR(map.links[0].variance, std::pow(params.step_sigma, 2) + 0.09 + 1e-4, 1e-12);
}

}  // namespace
}  // namespace opp::mapping
