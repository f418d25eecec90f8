// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/join_parts.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/core/se3.h"
#include "opp/mapping/io/parameters.h"
#include "opp/mapping/loop/join_maps.h"
#include "opp/mapping/loop/map_conflict.h"
#include "opp/mapping/pipeline/mapper.h"
#include "opp/mapping/simulation/lidar.h"
#include "opp/mapping/simulation/solids.h"

#include "support/random.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

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
  ScanFeatures scan = test::scanOfScene(scene, step, poseAt(step));
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

TEST(JoinParts, JoinsTwoSessionsOfOneRoomWithoutAGuess) {
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

MapPart partWith(const MapState& map, int id) {
  MapPart part(id, LoopParams());
  part.map = map;
  part.indexFrom(0);
  return part;
}

/// A map of so many scans from `first` on, as part `id`.
MapPart partOf(const test::Rectangles& scene, int id, int first, int scans = 16) {
  Mapper mapper{MapperParams()};
  for (int step = first; step < first + scans; ++step)
    mapper.add(scanAt(scene, step), std::nullopt);
  return partWith(mapper.map(), id);
}

TEST(JoinParts, BelievesMotionThatDeniesAJoin) {
  const test::Rectangles room = test::furnishedRoom(1);
  const std::vector<MapPart> parts = {partOf(room, 0, 0), partOf(room, 1, 40)};
  ExpectedBeginning beginning;
  beginning.last = {0, 15};
  beginning.first = {0, 40};
  beginning.information = Matrix6d::Identity() / 0.04;
  for (const double aside : {0.0, 4.0}) {
    beginning.last_from_first = poseAt(15).inverse() * poseAt(40);
    beginning.last_from_first.translation().x() += aside;
    std::vector<MapPart> some = parts;
    some[1].history.beginnings = {beginning};
    joinParts(some, MapperParams());
    EXPECT_EQ(some.size(), aside == 0.0 ? 1U : 2U) << aside;
  }
}

TEST(JoinParts, BelievesMotionThroughAPartBetween) {
  const test::Rectangles room = test::furnishedRoom(1);
  std::vector<MapPart> parts = {partOf(room, 0, 0), partOf(test::furnishedRoom(4), 1, 18, 3),
                                partOf(room, 2, 40)};
  ExpectedBeginning between, beginning;
  between.last = {0, 15};
  between.first = {0, 18};
  between.last_from_first = poseAt(15).inverse() * poseAt(18);
  between.information = Matrix6d::Identity() / 0.02;
  parts[1].history.beginnings = {between};
  beginning.last = {0, 20};
  beginning.first = {0, 40};
  beginning.information = Matrix6d::Identity() / 0.02;
  for (const double aside : {0.0, 4.0}) {
    beginning.last_from_first = poseAt(20).inverse() * poseAt(40);
    beginning.last_from_first.translation().x() += aside;
    std::vector<MapPart> some = parts;
    some[2].history.beginnings = {beginning};
    joinParts(some, MapperParams());
    EXPECT_EQ(some.size(), aside == 0.0 ? 2U : 3U) << aside;
  }
}

TEST(JoinParts, APlaceRecognizedWhereItCannotBeProvesNothing) {
  const test::Rectangles room = test::furnishedRoom(1);
  ExpectedBeginning elsewhere;
  elsewhere.last = {0, 27};
  elsewhere.first = {0, 40};
  elsewhere.last_from_first = poseAt(27).inverse() * poseAt(40);
  elsewhere.last_from_first.translation().x() += 4.0;
  elsewhere.information = Matrix6d::Identity() / 0.04;
  // The third sees the room too. That the second is another room like it takes away the proof.
  for (const bool repeats : {false, true}) {
    std::vector<MapPart> parts = {partOf(room, 0, 0, 28), partOf(room, 1, 40, 28),
                                  partOf(room, 2, 80, 28)};
    if (repeats) parts[1].history.beginnings = {elsewhere};
    joinParts(parts, MapperParams());
    EXPECT_EQ(parts.size(), repeats ? 3U : 1U);
  }
}

const Eigen::Isometry3d kAside(Eigen::Translation3d(10.0, 0.0, 0.0));

/// Makes another map part of `part`, 10 m aside.
void append(MapPart other, MapPart& part) {
  const int joint = static_cast<int>(part.map.keyframes.size());
  appendMap(kAside, std::move(other.map), part.map);
  part.map.links.push_back({joint - 1, joint, 1e-6});
  part.indexFrom(static_cast<std::size_t>(joint));
}

TEST(JoinParts, MotionTellsWhichOfTwoRoomsThatAreAlikeItIs) {
  // The first part saw two rooms of one kind 10 m apart; the second begins in the first of them, as
  // motion expects, or so vaguely that only what is seen could tell.
  const test::Rectangles room = test::furnishedRoom(1);
  for (const double sigma : {0.2, 20.0}) {
    std::vector<MapPart> parts = {partOf(room, 0, 0, 32), partOf(room, 1, 40, 32)};
    append(partOf(room, 0, 200, 32), parts[0]);
    ExpectedBeginning beginning;
    beginning.last = {0, 31};
    beginning.first = {0, 40};
    beginning.last_from_first = poseAt(31).inverse() * poseAt(40);
    beginning.information = Matrix6d::Identity() / (sigma * sigma);
    parts[1].history.beginnings = {beginning};
    joinParts(parts, MapperParams());
    ASSERT_EQ(parts.size(), sigma < 1.0 ? 1U : 2U) << sigma;
    if (parts.size() == 2) continue;
    const LocalizedScan& last = parts[0].map.scans.back();
    const Eigen::Isometry3d expected =
        poseAt(0).inverse() * poseAt(static_cast<int>(last.scan_index));
    EXPECT_LT(difference(poseOf(parts[0].map, last), expected).norm(), 0.01);
  }
}

TEST(JoinParts, ClaimsThatMotionDeniesTogetherNeedTwiceAsManyKeyframes) {
  const test::Rectangles room = test::furnishedRoom(1), other = test::furnishedRoom(4);
  // The second part sees the one room, the third the other. From the one to the other the body went
  // as the first part has it, or elsewhere: then one of both rooms is another like it. Few scans of
  // the first part saw the one room: it is the second part's keyframes that count.
  for (const bool elsewhere : {false, true}) {
    for (const int scans : {12, 32}) {
      std::vector<MapPart> parts = {partOf(room, 0, 0, 6), partOf(room, 1, 400, scans),
                                    partOf(other, 2, 600, 32)};
      append(partOf(other, 0, 200, 16), parts[0]);
      const int last = 400 + scans - 1;
      ExpectedBeginning beginning;
      beginning.last = {0, static_cast<std::size_t>(last)};
      beginning.first = {0, 600};
      Eigen::Isometry3d aside = kAside;
      if (elsewhere) aside.translation().x() -= 4.0;
      beginning.last_from_first =
          poseAt(last).inverse() * poseAt(0) * aside * poseAt(200).inverse() * poseAt(600);
      beginning.information = Matrix6d::Identity() / 0.04;
      parts[2].history.beginnings = {beginning};
      joinParts(parts, MapperParams());
      EXPECT_EQ(parts.size(), !elsewhere ? 1U : scans == 32 ? 3U : 2U) << elsewhere << scans;
    }
  }
}

TEST(JoinParts, AShortPartJoinsALongOneWhicheverCameFirst) {
  const test::Rectangles room = test::furnishedRoom(2);
  const MapPart short_part = partOf(room, 0, 0, 5), long_part = partOf(room, 1, 40, 32);
  for (const bool short_first : {true, false}) {
    std::vector<MapPart> parts = {short_part, long_part};
    if (!short_first) std::swap(parts[0], parts[1]);
    joinParts(parts, MapperParams());
    EXPECT_EQ(parts.size(), 1U) << short_first;
  }
}

void moveToSession(int session, MapPart& part) {
  for (LocalizedScan& scan : part.map.scans) scan.session = session;
  for (Keyframe& keyframe : part.map.keyframes) keyframe.features.session = session;
}

TEST(JoinParts, OneScanIsEnoughOnlyWhereMotionKnowsNothing) {
  MapperParams params;
  params.loop.certain_clarity = 0.4;  // these rooms look alike from two sides but for the furniture
  int joined = 0;
  for (std::uint64_t room = 1; room <= 5; ++room) {
    for (const int session : {0, 1}) {
      // A room, and one of the same kind as far as a scan of each tells.
      std::vector<MapPart> parts = {partOf(test::furnishedRoom(room), 0, 0, 1),
                                    partOf(test::furnishedRoom(room), 1, 2, 1)};
      moveToSession(session, parts[1]);
      joinParts(parts, params);
      if (session == 0)
        EXPECT_EQ(parts.size(), 2U) << "room " << room;
      else
        joined += parts.size() == 1 ? 1 : 0;
    }
  }
  EXPECT_GE(joined, 3);
}

TEST(JoinParts, FewKeyframesProveAJoinOnlyBetweenSessions) {
  int joined = 0;
  for (std::uint64_t room = 1; room <= 5; ++room) {
    for (const int session : {0, 1}) {
      std::vector<MapPart> parts = {partOf(test::furnishedRoom(room), 0, 0),
                                    partOf(test::furnishedRoom(room), 1, 40)};
      ASSERT_LT(parts[1].map.keyframes.size(), 5U);
      moveToSession(session, parts[1]);
      joinParts(parts, MapperParams());
      if (session == 0)
        EXPECT_EQ(parts.size(), 2U) << "room " << room;
      else
        joined += parts.size() == 1 ? 1 : 0;
    }
  }
  EXPECT_GE(joined, 3);
}

TEST(JoinParts, AScanWhereMotionExpectsItIsBelievedIfThreeKeyframesClaimIt) {
  MapperParams params;
  params.loop.certain_clarity = 1.0;
  int joined = 0;
  for (std::uint64_t room = 1; room <= 5; ++room) {
    for (const int scans : {8, 16}) {
      std::vector<MapPart> parts = {partOf(test::furnishedRoom(room), 0, 0, scans),
                                    partOf(test::furnishedRoom(room), 1, 40, 1)};
      ExpectedBeginning beginning;
      beginning.last = {0, static_cast<std::size_t>(scans - 1)};
      beginning.first = {0, 40};
      beginning.last_from_first = poseAt(scans - 1).inverse() * poseAt(40);
      beginning.information = Matrix6d::Identity() / 0.04;
      parts[1].history.beginnings = {beginning};
      const bool is_two = parts[0].map.keyframes.size() == 2;
      ASSERT_EQ(is_two, scans == 8);
      joinParts(parts, params);
      if (is_two)
        EXPECT_EQ(parts.size(), 2U) << "room " << room;
      else
        joined += parts.size() == 1 ? 1 : 0;
    }
  }
  EXPECT_GE(joined, 4);
}

TEST(JoinParts, JoinsAlikeForEveryNumberOfThreads) {
  const test::Rectangles room = test::furnishedRoom(3);
  const std::vector<MapPart> parts = {partOf(room, 0, 0, 28), partOf(room, 1, 40, 28)};
  std::vector<MapPart> alone = parts;
  joinParts(alone, MapperParams());
  ASSERT_EQ(alone.size(), 1U);
  for (const int threads : {2, 5}) {
    std::vector<MapPart> together = parts;
    joinParts(together, MapperParams(), threads);
    ASSERT_EQ(together.size(), 1U);
    for (std::size_t k = 0; k < alone[0].map.keyframes.size(); ++k) {
      EXPECT_EQ(together[0].map.keyframes[k].map_from_body.matrix(),
                alone[0].map.keyframes[k].map_from_body.matrix());
    }
  }
}

TEST(JoinParts, DoesNotCompareWhatWasTakenAsunder) {
  const test::Rectangles room = test::furnishedRoom(1);
  std::vector<MapPart> parts = {partOf(room, 0, 0), partOf(room, 1, 40)};
  parts[1].history.origins = parts[0].history.origins;
  joinParts(parts, MapperParams());
  EXPECT_EQ(parts.size(), 2U);
}

TEST(JoinParts, LeavesDifferentRoomsApart) {
  for (std::uint64_t room = 1; room <= 5; ++room) {
    const Mapper mapper = mapTwice(test::furnishedRoom(room), test::furnishedRoom(room + 20), 12);
    ASSERT_EQ(mapper.parts().size(), 2U) << "room " << room;
    EXPECT_EQ(mapper.parts()[0].map.scans.size(), 12U);
    EXPECT_EQ(mapper.parts()[1].map.scans.size(), 12U);
  }
}

TEST(JoinParts, ClaimsNothingInARoomThatLooksTheSameFromTwoSides) {
  const test::Rectangles room = test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5});
  const Mapper mapper = mapTwice(room, room, 12);
  EXPECT_EQ(mapper.parts().size(), 2U);
}

/// What an ideal lidar of 16 beams sees in an empty hall of 30 × 20 m, too high for it to see the
/// ceiling.
ScanFeatures scanOfHall(const Eigen::Isometry3d& hall_from_sensor, int index,
                        const MapperParams& params) {
  World hall;
  addRoom(hall, {{-15, -10}, {15, -10}, {15, 10}, {-15, 10}}, 0.0, 10.0);
  const auto stream = static_cast<std::uint64_t>(index);
  PointCloud cloud;
  LidarModel lidar;
  lidar.noise = lidar.dropout = 0.0;
  cloud.points = sweep(RayTracer(hall), hall_from_sensor, lidar, 1, stream).points;
  ScanFeatures scan = detectFeatures(cloud, params.primitives);
  scan.timestamp = index;
  scan.scan_index = static_cast<std::size_t>(index);
  return scan;
}

TEST(JoinParts, TwoScansOfASymmetricHallThatLookAlikeMayBeFromOppositePlaces) {
  // From opposite places the hall looks the same, and from one place quite different where the
  // beams leave gaps: the only pose with much in common is the wrong one.
  MapperParams params;
  loadParameters(OPP_SOURCE_FOLDER "/config/lidar.ini", params);
  test::Random random(1);
  for (int trial = 0; trial < 4; ++trial) {
    const double x = random.uniform(-12.5, -10.5), y = random.uniform(-9.0, -8.0);
    const Eigen::Isometry3d first(Eigen::Translation3d(x, y, 0.8));
    const Eigen::Isometry3d second =
        Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitZ()) * first *
        Eigen::AngleAxisd(random.uniform(-0.1, 0.1), Eigen::Vector3d::UnitZ());
    std::vector<MapPart> parts;
    for (const int p : {0, 1}) {
      Mapper mapper(params);
      mapper.add(scanOfHall(p == 0 ? first : second, p, params), std::nullopt);
      parts.push_back(partWith(mapper.map(), p));
    }
    joinParts(parts, params);
    EXPECT_EQ(parts.size(), 2U) << trial;
  }
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
    EXPECT_LT(conflictOf(views, views, Eigen::Isometry3d::Identity(), params).value(), 0.02);
    const Eigen::Isometry3d aside(Eigen::Translation3d(0.8, 0.5, 0.0));
    EXPECT_GT(conflictOf(views, views, aside, params).value(), 0.1);
    const Eigen::Isometry3d away(Eigen::Translation3d(80.0, 0.0, 0.0));
    EXPECT_EQ(conflictOf(views, views, away, params), std::nullopt);
  }
}

}  // namespace
}  // namespace opp::mapping
