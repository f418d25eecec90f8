// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/match_place.h"

#include "opp/mapping/core/se3.h"
#include "opp/mapping/frontend/insert_keyframe.h"

#include "support/random.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

ScanFeatures scanOf(std::uint64_t room, const Eigen::Isometry3d& scene_from_body,
                    std::uint64_t seed) {
  test::SyntheticOptions options;
  options.spacing = 0.08;
  options.sigma = 0.003;
  options.seed = seed;
  return test::trueFeatures(test::sampleScene(test::furnishedRoom(room),
                                              scene_from_body.translation(),
                                              scene_from_body.inverse(), options));
}

Eigen::Isometry3d standing(double x, double y, double yaw) {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(x, y, 1.3);
  return pose;
}

MapState mapOf(std::uint64_t room, const Eigen::Isometry3d& pose) {
  MapState map;
  MatchResult match;
  match.map_from_body = pose;
  insertKeyframe(scanOf(room, pose, 1), match, SensorModel(), map);
  return map;
}

std::optional<PlaceMatch> findIn(const MapState& map, const ScanFeatures& scan,
                                 const std::optional<PosePrior>& expected) {
  return matchPlace(map, 0, scan, scan, expected, MapperParams());
}

double error(const PlaceMatch& match, const Eigen::Isometry3d& keyframe_from_body) {
  return difference(keyframe_from_body, match.keyframe_from_body).norm();
}

TEST(MatchPlace, FindsTheScanWithoutAGuess) {
  test::Random random(1);
  int found = 0;
  for (std::uint64_t room = 1; room <= 10; ++room) {
    const Eigen::Isometry3d at = standing(0.0, 0.0, 0.0);
    const Eigen::Isometry3d body =
        standing(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-3.0, 3.0));
    const auto match = findIn(mapOf(room, at), scanOf(room, body, 2), std::nullopt);
    if (!match) continue;  // some of these rooms are nearly symmetric
    ++found;
    EXPECT_LT(error(*match, at.inverse() * body), 5e-3) << "room " << room;
    EXPECT_GT(match->overlap, 0.5);
    EXPECT_GT(match->information(3, 3), 0.0);
  }
  EXPECT_GE(found, 8);
}

TEST(MatchPlace, UsesAnExpectedPose) {
  for (std::uint64_t room = 1; room <= 10; ++room) {
    const Eigen::Isometry3d at = standing(0.0, 0.0, 0.0), body = standing(0.3, -0.2, 0.4);
    PosePrior drifted;
    Vector6d error_of_guess;
    error_of_guess << 0.01, -0.01, 0.02, 0.05, -0.08, 0.03;
    drifted.map_from_body = retract(body, error_of_guess);
    drifted.information = 100.0 * Matrix6d::Identity();
    const auto match = findIn(mapOf(room, at), scanOf(room, body, 2), drifted);
    ASSERT_TRUE(match) << "room " << room;
    EXPECT_LT(error(*match, at.inverse() * body), 5e-3) << "room " << room;
  }
}

TEST(MatchPlace, FindsNothingInAnotherRoom) {
  for (std::uint64_t room = 1; room <= 10; ++room) {
    const auto match = findIn(mapOf(room, standing(0.0, 0.0, 0.0)),
                              scanOf(room + 20, standing(0.3, 0.2, 0.5), 2), std::nullopt);
    EXPECT_FALSE(match) << "room " << room;
  }
}

TEST(MatchPlace, BelievesNoExpectedPoseThatFreeSpaceDenies) {
  test::Random random(2);
  for (int k = 0; k < 10; ++k) {
    // The same bare room, but for two walls that stand nearer: most of the scan agrees.
    const Eigen::Vector3d corner(random.uniform(1.7, 2.0), random.uniform(1.7, 2.0), 3.5);
    const Eigen::Isometry3d at = standing(0.0, 0.0, 0.0);
    const auto scan = [&](double nearer, std::uint64_t seed) {
      test::SyntheticOptions options;
      options.spacing = 0.08;
      options.sigma = 0.003;
      options.seed = seed;
      const auto room = test::roomSides({-corner.x(), -corner.y(), 0.0},
                                        {corner.x() - nearer, corner.y() - nearer, corner.z()});
      return test::trueFeatures(test::sampleScene(room, at.translation(), at.inverse(), options));
    };
    MapState map;
    MatchResult match;
    match.map_from_body = at;
    insertKeyframe(scan(0.0, 1), match, SensorModel(), map);
    PosePrior expected;
    expected.map_from_body = at;
    expected.information = 1e4 * Matrix6d::Identity();
    EXPECT_TRUE(findIn(map, scan(0.0, 2), expected)) << "room " << k;
    EXPECT_FALSE(findIn(map, scan(0.9, 2), expected)) << "room " << k;
  }
}

TEST(MatchPlace, OfAnEmptyScanIsNothing) {
  EXPECT_FALSE(findIn(mapOf(1, standing(0.0, 0.0, 0.0)), ScanFeatures(), std::nullopt));
}

}  // namespace
}  // namespace opp::mapping
