// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/pipeline/mapper.h"

#include "opp/mapping/core/se3.h"
#include "opp/mapping/planar/planar_map_of_landmarks.h"

#include "support/random.h"
#include "support/sensors.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

ScanFeatures scanAt(int step, std::uint64_t room, double sigma) {
  ScanFeatures scan = test::scanOfRoom(room, step, test::poseOnCircle(step), sigma);
  scan.scan_index = static_cast<std::size_t>(step);
  return scan;
}

/// Largest translation and rotation error of a trajectory that starts at the truth.
std::pair<double, double> worstErrors(const Trajectory& trajectory) {
  std::pair<double, double> worst{0.0, 0.0};
  for (const StampedPose& pose : trajectory) {
    const int step = static_cast<int>(std::lround(pose.timestamp / test::kTimeStep));
    const Vector6d error = difference(test::poseOnCircle(step), pose.map_from_body);
    worst.first = std::max(worst.first, error.tail<3>().norm());
    worst.second = std::max(worst.second, error.head<3>().norm());
  }
  return worst;
}

Mapper mapRoom(std::uint64_t room, int steps, double sigma) {
  Mapper mapper{MapperParams()};
  mapper.setInitialPose(test::poseOnCircle(0));
  for (int step = 0; step < steps; ++step) mapper.add(scanAt(step, room, sigma), std::nullopt);
  mapper.finish();
  return mapper;
}

TEST(Mapper, FollowsABodyThroughRoomsWithinTheNoise) {
  for (std::uint64_t room = 1; room <= 5; ++room) {
    const Mapper mapper = mapRoom(room, 30, 0.003);
    ASSERT_EQ(trajectoryOf(mapper.map()).size(), 30U);
    const auto [translation, rotation] = worstErrors(trajectoryOf(mapper.map()));
    // Thousands of samples with 3 mm of noise fix a pose to a tenth of a millimetre; the part of
    // the noise that is taken as systematic and the keyframes in between leave a millimetre.
    EXPECT_LT(translation, 1e-3) << "room " << room;
    EXPECT_LT(rotation, 1e-3) << "room " << room;
  }
}

TEST(Mapper, KeepsOneLandmarkPerPlane) {
  const Mapper mapper = mapRoom(3, 60, 0.002);
  EXPECT_GT(mapper.map().keyframes.size(), 3U);
  const auto& landmarks = mapper.map().landmarks.planes;
  for (std::size_t a = 0; a < landmarks.size(); ++a) {
    for (std::size_t b = a + 1; b < landmarks.size(); ++b) {
      const Plane& first = landmarks[a].plane_in_map;
      const Plane& second = landmarks[b].plane_in_map;
      // Planes of these rooms that face the same way are at least 5 cm apart (seen along the
      // normal).
      const bool same =
          angleBetween(first, second) < 0.02 && std::abs(first.d() - second.d()) < 0.02;
      EXPECT_FALSE(same) << a << " and " << b << ": " << first << ", " << second;
    }
  }
}

TEST(Mapper, WhatHoldsNothingIsNotLocalized) {
  Mapper mapper{MapperParams()};
  EXPECT_FALSE(mapper.add({}, std::nullopt).localized);
  EXPECT_TRUE(trajectoryOf(mapper.map()).empty());
  EXPECT_TRUE(mapper.add(scanAt(0, 1, 0.0), std::nullopt).is_keyframe);
  EXPECT_FALSE(mapper.add({}, std::nullopt).localized);
  mapper.finish();
  EXPECT_EQ(posesOf(mapper.map(), 0).size(), 1U);
  EXPECT_EQ(posesOf(mapper.map(), 0).count(0), 1U);
}

TEST(Mapper, BeginsAnewAtOnceWhereItCannotKnowThePlaceAnyMore) {
  Mapper mapper{MapperParams()};
  for (int step = 0; step < 12; ++step) mapper.add(scanAt(step, 1, 0.003), std::nullopt);
  ScanFeatures later = scanAt(12, 1, 0.003);
  later.timestamp += 60.0;
  EXPECT_TRUE(mapper.add(std::move(later), std::nullopt).is_keyframe);
  ASSERT_EQ(mapper.parts().size(), 2U);
  EXPECT_EQ(mapper.parts()[0].map.scans.size(), 12U);
  EXPECT_EQ(mapper.parts()[1].map.scans.size(), 1U);
}

/// The `step`-th scan of a body that walks along a wall, ever faster.
Eigen::Isometry3d besideWall(int step) {
  const double time = test::kTimeStep * step;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.0, 0.3 * time + 0.75 * time * time, 1.2);
  return pose;
}

/// Maps a way along a wall, `pose_after(step)`, on which the wall behind is seen up to
/// `last_behind` and the one ahead from `first_ahead` on. \param lost how many scans were not
/// localized
Mapper mapWayAlongWall(Eigen::Isometry3d (*pose_after)(int), int last_behind, int first_ahead,
                       int last_step, std::uint64_t seed, int& lost) {
  const test::Rectangle wall = {{2.0, 0.0, 1.3}, {0.0, 0.0, 1.3}, {0.0, 4.0, 0.0}};
  const test::Rectangle floor = {{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 4.0, 0.0}};
  const test::Rectangle behind = {{-0.5, -1.0, 1.3}, {0.0, 0.0, 1.3}, {2.5, 0.0, 0.0}};
  const test::Rectangle ahead = {{-0.5, 3.5, 1.3}, {0.0, 0.0, 1.3}, {-2.5, 0.0, 0.0}};
  Mapper mapper{MapperParams()};
  mapper.setInitialPose(pose_after(0));
  lost = 0;
  for (int step = 0; step <= last_step; ++step) {
    test::Rectangles seen = {wall, floor};
    if (step <= last_behind) seen.push_back(behind);
    if (step >= first_ahead) seen.push_back(ahead);
    test::SyntheticOptions options;
    options.spacing = 0.05;
    options.sigma = 0.003;
    options.seed = 100 * seed + static_cast<std::uint64_t>(step);
    const Eigen::Isometry3d pose = pose_after(step);
    ScanFeatures scan =
        test::trueFeatures(test::sampleScene(seen, pose.translation(), pose.inverse(), options));
    scan.timestamp = test::kTimeStep * step;
    scan.scan_index = static_cast<std::size_t>(step);
    lost += mapper.add(std::move(scan), std::nullopt).localized ? 0 : 1;
  }
  mapper.finish();
  return mapper;
}

TEST(Mapper, WhatComesIntoViewPastABareWallLiesWhereTheWayBeforeAndAfterPutIt) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    int lost = 0;
    const Mapper mapper = mapWayAlongWall(besideWall, 5, 8, 15, seed, lost);
    EXPECT_EQ(lost, 0) << "seed " << seed;
    ASSERT_EQ(mapper.map().scans.size(), 16U);
    // The speed before alone is 0.08 m off after 0.3 s of this acceleration.
    for (const LocalizedScan& scan : mapper.map().scans) {
      const Eigen::Isometry3d truth = besideWall(static_cast<int>(scan.scan_index));
      EXPECT_LT((poseOf(mapper.map(), scan).translation() - truth.translation()).norm(), 0.015)
          << "seed " << seed << " scan " << scan.scan_index;
    }
  }
}

constexpr int kStops = 11, kGoesOn = 17;

/// A body that walks along a wall and stops, for .6 s, while nothing but the wall is seen.
Eigen::Isometry3d besideWallWithAStop(int step) {
  const int walked = step <= kStops ? step : std::max(kStops, step - (kGoesOn - kStops));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.0, 0.4 * test::kTimeStep * walked, 1.2);
  return pose;
}

TEST(Mapper, WhatMotionAloneTiesTooLooselyIsNotOneMap) {
  constexpr int kFirstAhead = 20, kLast = 32;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    int lost = 0;
    const Mapper mapper =
        mapWayAlongWall(besideWallWithAStop, kStops, kFirstAhead, kLast, seed, lost);
    ASSERT_EQ(mapper.parts().size(), 2U) << "seed " << seed;
    std::set<std::size_t> known;
    for (const MapPart& part : mapper.parts()) {
      const auto errorOf = [&](const LocalizedScan& scan) -> Eigen::Vector3d {
        return (poseOf(part.map, scan) *
                besideWallWithAStop(static_cast<int>(scan.scan_index)).inverse())
            .translation();
      };
      const Eigen::Vector3d first = errorOf(part.map.scans.front());
      for (const LocalizedScan& scan : part.map.scans) {
        // Nothing tells of the stop before the scans after it: three standard deviations of what is
        // kept, see loosest_tie.
        const auto step = static_cast<int>(scan.scan_index);
        const bool is_seen = step <= kStops || step >= kFirstAhead;
        EXPECT_LT((errorOf(scan) - first).norm(), is_seen ? 0.01 : 0.15)
            << "seed " << seed << " scan " << step;
        known.insert(scan.scan_index);
      }
    }
    // Where it stood nobody can tell.
    for (const int step : {kStops + 4, kGoesOn})
      EXPECT_EQ(known.count(static_cast<std::size_t>(step)), 0U) << "seed " << seed;
    EXPECT_GE(known.size(), std::size_t(kStops + 1 + kLast + 1 - kFirstAhead));
  }
}

TEST(PlanarMapOf, DescribesTheRoom) {
  const Mapper mapper = mapRoom(2, 20, 0.001);
  const PlanarMap map = planarMapOf(mapper.map(), SensorModel(), PlanarParams());
  ASSERT_FALSE(map.planes.empty());
  for (const PlanarMapPlane& plane : map.planes) {
    EXPECT_FALSE(plane.polygons.empty());
    EXPECT_GT(plane.area, 0.0);
    EXPECT_FALSE(plane.observations.empty());
    for (const PlanarPolygon& polygon : plane.polygons) {
      for (const Eigen::Vector3d& vertex : polygon.outer) {
        EXPECT_NEAR(plane.plane.signedDistance(vertex), 0.0, 1e-9);
      }
    }
  }
  // Four walls, floor and ceiling meet in eight corners; furniture adds its own.
  EXPECT_GE(map.corners.size(), 8U);
  EXPECT_GE(map.lines.size(), 12U);
  EXPECT_EQ(map.families.empty(), false);
  for (const PlanarMapLine& line : map.lines) {
    for (const int id : line.planes) {
      EXPECT_NEAR(map.planes[static_cast<std::size_t>(id)].plane.signedDistance(line.start), 0.0,
                  1e-9);
      EXPECT_NEAR(map.planes[static_cast<std::size_t>(id)].plane.signedDistance(line.end), 0.0,
                  1e-9);
    }
  }
  for (const PlanarMapCorner& corner : map.corners) {
    for (const int id : corner.planes) {
      EXPECT_NEAR(map.planes[static_cast<std::size_t>(id)].plane.signedDistance(corner.position),
                  0.0, 1e-9);
    }
    EXPECT_NEAR(corner.orientation.norm(), 1.0, 1e-12);
  }
}

TEST(PlanarMapOf, LeavesOutPlanesWhosePlaceIsUncertain) {
  const Mapper mapper = mapRoom(2, 20, 0.001);
  const SensorModel sensor = test::sensorThatBends(0.02);
  PlanarParams params;
  params.max_position_error = 100.0;
  const std::size_t all = planarMapOf(mapper.map(), sensor, params).planes.size();
  params.max_position_error = 0.003;
  const PlanarMap some = planarMapOf(mapper.map(), sensor, params);
  EXPECT_LT(some.planes.size(), all) << "the furniture is narrower than the walls";
  EXPECT_FALSE(some.planes.empty());
  params.max_position_error = 1e-6;
  const PlanarMap none = planarMapOf(mapper.map(), sensor, params);
  EXPECT_TRUE(none.planes.empty() && none.lines.empty() && none.corners.empty());
}

TEST(PlanarMapOf, AnEmptyMapIsEmpty) {
  const PlanarMap map = planarMapOf(MapState(), SensorModel(), PlanarParams());
  EXPECT_TRUE(map.planes.empty() && map.families.empty() && map.lines.empty() &&
              map.corners.empty());
}

}  // namespace
}  // namespace opp::mapping
