// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/map_joiner.h"

#include "opp/mapping/core/se3.h"
#include "opp/mapping/loop/map_conflict.h"
#include "opp/mapping/pipeline/mapper.h"

#include "support/random.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

/// A body that walks an arc and looks around; `from` is the step it begins with.
Eigen::Isometry3d poseAt(int step) {
  const double phase = 0.12 * step;
  Eigen::Isometry3d pose(Eigen::AngleAxisd(phase, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(0.4 * std::cos(phase), 0.4 * std::sin(phase), 1.3);
  return pose;
}

ScanFeatures scanAt(const test::Rectangles& scene, int step) {
  test::SyntheticOptions options;
  options.spacing = 0.08;
  options.sigma = 0.003;
  options.seed = static_cast<std::uint64_t>(step);
  ScanFeatures scan = test::trueFeatures(
      test::sampleScene(scene, poseAt(step).translation(), poseAt(step).inverse(), options));
  scan.timestamp = 0.1 * step;
  scan.scan_index = static_cast<std::size_t>(step);
  return scan;
}

/// Two sessions of `steps` scans each, in one scene or two.
Mapper mapTwice(const test::Rectangles& first, const test::Rectangles& second, int steps) {
  Mapper mapper{MapperParams()};
  mapper.setInitialPose(poseAt(0));
  for (int session = 0; session < 2; ++session) {
    mapper.startSession();
    for (int step = 0; step < steps; ++step) {
      ScanFeatures scan = scanAt(session == 0 ? first : second, step + 40 * session);
      scan.session = session;
      mapper.add(std::move(scan), std::nullopt);
    }
  }
  mapper.finish();
  return mapper;
}

TEST(MapJoiner, JoinsTwoSessionsOfOneRoomWithoutAGuess) {
  int joined = 0;
  for (std::uint64_t room = 1; room <= 5; ++room) {
    const Mapper mapper = mapTwice(test::furnishedRoom(room), test::furnishedRoom(room), 16);
    if (mapper.parts().size() != 1) continue;  // nothing false is claimed
    ++joined;
    EXPECT_GE(mapper.map().loop_closures, 1U);
    EXPECT_EQ(mapper.map().scans.size(), 32U);
    for (const auto& [index, pose] : posesOf(mapper.map(), 1)) {
      EXPECT_LT(difference(poseAt(static_cast<int>(index)), pose).norm(), 5e-3)
          << "room " << room << " scan " << index;
    }
  }
  EXPECT_GE(joined, 4);
}

/// A map of the scans from `first` on, as part `id`.
MapPart partOf(const test::Rectangles& scene, int id, int first) {
  Mapper mapper{MapperParams()};
  for (int step = first; step < first + 16; ++step) mapper.add(scanAt(scene, step), std::nullopt);
  MapPart part(id, LoopParams());
  part.map = mapper.map();
  for (const Keyframe& keyframe : part.map.keyframes)
    part.index.add(keyframe.features.primitives_in_body);
  return part;
}

TEST(MapJoiner, BelievesMotionThatDeniesAJoin) {
  const test::Rectangles room = test::furnishedRoom(1);
  const std::vector<MapPart> parts = {partOf(room, 0, 0), partOf(room, 1, 40)};
  ExpectedBeginning beginning;
  beginning.last_scan = 15;
  beginning.first_scan = 40;
  beginning.information = Matrix6d::Identity() / 0.04;
  for (const double aside : {0.0, 4.0}) {
    beginning.last_from_first = poseAt(15).inverse() * poseAt(40);
    beginning.last_from_first.translation().x() += aside;
    std::vector<MapPart> some = parts;
    some[1].history.beginnings = {beginning};
    MapJoiner(MapperParams()).joinAll(some);
    EXPECT_EQ(some.size(), aside == 0.0 ? 1U : 2U) << aside;
  }
}

TEST(MapJoiner, APlaceRecognizedWhereItCannotBeProvesNothing) {
  const test::Rectangles room = test::furnishedRoom(1);
  ExpectedBeginning elsewhere;
  elsewhere.last_scan = 15;
  elsewhere.first_scan = 40;
  elsewhere.last_from_first = poseAt(15).inverse() * poseAt(40);
  elsewhere.last_from_first.translation().x() += 4.0;
  elsewhere.information = Matrix6d::Identity() / 0.04;
  // The third sees the room too. That the second is another room like it takes away the proof.
  for (const bool repeats : {false, true}) {
    std::vector<MapPart> parts = {partOf(room, 0, 0), partOf(room, 1, 40), partOf(room, 2, 80)};
    if (repeats) parts[1].history.beginnings = {elsewhere};
    MapJoiner(MapperParams()).joinAll(parts);
    EXPECT_EQ(parts.size(), repeats ? 3U : 1U);
  }
}

TEST(MapJoiner, DoesNotCompareWhatWasTakenAsunder) {
  const test::Rectangles room = test::furnishedRoom(1);
  std::vector<MapPart> parts = {partOf(room, 0, 0), partOf(room, 1, 40)};
  parts[1].history.origins = parts[0].history.origins;
  MapJoiner(MapperParams()).joinAll(parts);
  EXPECT_EQ(parts.size(), 2U);
}

TEST(MapJoiner, LeavesDifferentRoomsApart) {
  for (std::uint64_t room = 1; room <= 5; ++room) {
    const Mapper mapper = mapTwice(test::furnishedRoom(room), test::furnishedRoom(room + 20), 12);
    ASSERT_EQ(mapper.parts().size(), 2U) << "room " << room;
    EXPECT_EQ(mapper.parts()[0].map.scans.size(), 12U);
    EXPECT_EQ(mapper.parts()[1].map.scans.size(), 12U);
  }
}

TEST(MapJoiner, ClaimsNothingInARoomThatLooksTheSameFromTwoSides) {
  const test::Rectangles room = test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5});
  const Mapper mapper = mapTwice(room, room, 12);
  EXPECT_EQ(mapper.parts().size(), 2U);
}

TEST(Mapper, GivesUpPartsOfFewScansAndKeepsTheFirst) {
  const Mapper mapper = mapTwice(test::furnishedRoom(1), test::furnishedRoom(21), 4);
  ASSERT_EQ(mapper.parts().size(), 1U);
  EXPECT_EQ(mapper.map().scans.size(), 4U);
}

TEST(ConflictOf, IsSmallForTheTruePoseAndLargeForAWrongOne) {
  for (std::uint64_t room = 1; room <= 5; ++room) {
    const Mapper mapper = mapTwice(test::furnishedRoom(room), test::furnishedRoom(room + 20), 4);
    const KeyframeViews views = viewsOf(mapper.map());
    const MapperParams params;
    EXPECT_LT(conflictOf(views, views, Eigen::Isometry3d::Identity(), params), 0.02);
    const Eigen::Isometry3d aside(Eigen::Translation3d(0.8, 0.5, 0.0));
    EXPECT_GT(conflictOf(views, views, aside, params), 0.1);
    const Eigen::Isometry3d away(Eigen::Translation3d(80.0, 0.0, 0.0));
    EXPECT_EQ(conflictOf(views, views, away, params), 1.0) << "nothing in common proves nothing";
  }
}

}  // namespace
}  // namespace opp::mapping
