// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/add_views.h"
#include "opp/mapping/frontend/adopt_views.h"
#include "opp/mapping/frontend/insert_keyframe.h"
#include "opp/mapping/frontend/merge_covered.h"
#include "opp/mapping/planar/planar_map_of_landmarks.h"

#include "support/random.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

constexpr double kCell = 0.025;
constexpr double kSigma = 0.003;
const test::Rectangles kRoom = test::roomSides({-2.0, -2.0, 0.0}, {2.0, 2.0, 2.5});
/// A board that hangs in the room and faces its middle, with another one in front of the
/// lower half of it.
constexpr double kGap = 0.05;
const test::Rectangle kBoard = {{1.5, 0.0, 1.4}, {0.0, -0.5, 0.0}, {0.0, 0.0, 0.4}};
const test::Rectangle kFront = {{1.5 - kGap, 0.0, 1.1}, {0.0, -0.5, 0.0}, {0.0, 0.0, 0.1}};

Eigen::Isometry3d bodyPose(test::Random& random) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.0, 0.0, 1.2) + random.vector(0.2);
  return pose;
}

ScanFeatures scanOf(const test::Rectangles& things, const Eigen::Isometry3d& pose, int step) {
  test::Rectangles scene = kRoom;
  scene.insert(scene.end(), things.begin(), things.end());
  ScanFeatures scan = test::scanOfScene(scene, step, pose, kSigma);
  scan.timestamp = step;
  return scan;
}

/// Adds a keyframe at its true pose, whose first `known` planes are the landmarks of that id.
void addKeyframe(const test::Rectangles& things, const Eigen::Isometry3d& pose, int step, int known,
                 MapState& map) {
  MatchResult match;
  match.map_from_body = pose;
  for (int p = 0; p < known; ++p) match.planes.push_back({p, p});
  const int id = insertKeyframe(scanOf(things, pose, step), match, SensorModel(), map);
  map.scans.push_back(
      {map.keyframes.back().features.timestamp, 0, 0, id, Eigen::Isometry3d::Identity()});
}

/// Adds a scan that follows the newest keyframe; registration found the room's sides.
void addScan(const test::Rectangles& things, const Eigen::Isometry3d& pose, int step,
             MapState& map) {
  Keyframe& keyframe = map.keyframes.back();
  std::vector<PlaneAssociation> known;
  for (int p = 0; p < static_cast<int>(kRoom.size()); ++p) known.push_back({p, p});
  const Eigen::Isometry3d keyframe_from_body = keyframe.map_from_body.inverse() * pose;
  const ScanFeatures scan = scanOf(things, pose, step);
  addViews(scan, known, keyframe_from_body, SensorModel(), kCell, keyframe);
  const auto id = static_cast<int>(map.keyframes.size()) - 1;
  map.scans.push_back({scan.timestamp, 0, 0, id, keyframe_from_body});
}

TEST(ScanViews, TellWhatTheKeyframeSawFromWhatItDidNot) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    test::Random random(seed);
    MapState map;
    addKeyframe({}, bodyPose(random), 0, 0, map);
    for (int step = 1; step <= 4; ++step) addScan({kBoard, kFront}, bodyPose(random), step, map);
    const std::vector<PlaneView>& views = map.keyframes[0].views.planes;
    ASSERT_EQ(views.size(), kRoom.size() + 2) << "seed " << seed;
    for (const PlaneView& view : views) {
      EXPECT_EQ(view.timestamps, (std::vector<double>{1.0, 2.0, 3.0, 4.0}));
      EXPECT_EQ(view.is_own, view.keyframe_plane >= 0);
    }
    EXPECT_EQ(std::count_if(views.begin(), views.end(), [](const auto& v) { return v.is_own; }),
              static_cast<std::ptrdiff_t>(kRoom.size()));
    EXPECT_EQ(map.landmarks.planes.size(), kRoom.size()) << "they tie nothing";
  }
}

TEST(ScanViews, GrowWithWhatIsNewNotWithTheNumberOfScans) {
  test::Random random(1);
  MapState map;
  addKeyframe({}, bodyPose(random), 0, 0, map);
  const Eigen::Isometry3d pose = bodyPose(random);
  const auto size = [&] {
    const ScanViews& views = map.keyframes[0].views;
    std::size_t cells = 0;
    for (const PlaneView& view : views.planes) cells += view.support.size();
    return std::array<std::size_t, 4>{cells, views.planes.size(), views.lines.size(),
                                      views.corners.size()};
  };
  addScan({kBoard}, pose, 1, map);
  const auto first = size();
  EXPECT_GT(first[0], 0U);
  EXPECT_GT(first[2], 0U);
  EXPECT_GT(first[3], 0U);
  for (int step = 2; step <= 20; ++step) addScan({kBoard}, pose, step, map);
  const auto last = size();
  EXPECT_LT(last[0], 2 * first[0]) << "samples jitter within their cells' neighbourhood";
  EXPECT_EQ(last[1], first[1]);
  EXPECT_LE(last[2], first[2] + 2);
  EXPECT_EQ(last[3], first[3]);
}

TEST(AdoptViews, MakesOneLandmarkOfWhatScansOfSeveralKeyframesSaw) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    test::Random random(seed);
    MapState map;
    const int room = static_cast<int>(kRoom.size());
    for (int k = 0; k < 3; ++k) {
      addKeyframe({}, bodyPose(random), 10 * k, k == 0 ? 0 : room, map);
      for (int step = 1; step <= 3; ++step)
        addScan({kBoard, kFront}, bodyPose(random), 10 * k + step, map);
    }
    const std::vector<Keyframe> before = map.keyframes;
    EXPECT_EQ(adoptViews(SensorModel(), map), 2) << "seed " << seed;
    ASSERT_EQ(map.landmarks.planes.size(), kRoom.size() + 2);
    for (const test::Rectangle* board : {&kBoard, &kFront}) {
      const auto found = std::find_if(
          map.landmarks.planes.begin() + room, map.landmarks.planes.end(),
          [&](const PlaneLandmark& landmark) {
            return std::abs(landmark.plane_in_map.signedDistance(board->center)) < 0.3 * kGap;
          });
      ASSERT_NE(found, map.landmarks.planes.end());
      EXPECT_LT(angleBetween(found->plane_in_map, board->plane()), 0.02);
      EXPECT_EQ(found->observations.size(), 3U) << "one of each keyframe";
    }
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_TRUE(map.keyframes[k].map_from_body.isApprox(before[k].map_from_body, 0.0));
    EXPECT_EQ(map.factors.planes.size(), 3 * (kRoom.size() + 2));
  }
}

TEST(AdoptViews, PlanarMapsShowWhatNoKeyframeSaw) {
  test::Random random(3);
  MapState map;
  addKeyframe({}, bodyPose(random), 0, 0, map);
  for (int step = 1; step <= 3; ++step) addScan({kBoard}, bodyPose(random), step, map);
  adoptViews(SensorModel(), map);
  const PlanarMap planar = planarMapOf(map, SensorModel(), PlanarParams());
  const auto board = std::find_if(planar.planes.begin(), planar.planes.end(), [](const auto& p) {
    return std::abs(p.plane.signedDistance(kBoard.center)) < 0.01;
  });
  ASSERT_NE(board, planar.planes.end());
  EXPECT_EQ(board->observations, (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_NEAR(board->area, 0.8, 0.1);
  EXPECT_EQ(planar.planes.front().observations.size(), 4U) << "the keyframe and what follows";
}

/// Adds to a keyframe a patch of samples in mid-air that it takes for a plane.
void addPhantom(int id, MapState& map) {
  Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(id)];
  ScanFeatures& features = keyframe.features;
  PlanePrimitive phantom;
  const Eigen::Isometry3d body_from_map = keyframe.map_from_body.inverse();
  phantom.plane = transformed(body_from_map, Plane::fromPointNormal({1.0, 0, 1.2}, {-1, 0, 0}));
  const auto label = static_cast<int>(features.primitives_in_body.planes.size());
  for (double y = -0.4; y < 0.4; y += 0.05) {
    for (double z = 0.8; z < 1.6; z += 0.05) {
      const Eigen::Vector3d point = body_from_map * Eigen::Vector3d(1.0, y, z);
      OrientedCloud& cloud = features.cloud_in_body;
      cloud.points.push_back(point.cast<float>());
      cloud.normals.push_back(phantom.plane.normal().cast<float>());
      cloud.sigmas.push_back(static_cast<float>(kSigma));
      cloud.weights.push_back(1.0F);
      features.primitives_in_body.labels.push_back(label);
      phantom.moments.add(point, 1.0 / (kSigma * kSigma));
      ++phantom.support;
    }
  }
  features.primitives_in_body.planes.push_back(phantom);
  const auto landmark = static_cast<int>(map.landmarks.planes.size());
  keyframe.landmark_of_plane.push_back(landmark);
  map.landmarks.planes.push_back({transformed(keyframe.map_from_body, phantom.plane), {}});
  map.factors.planes.push_back({id, landmark, phantom.moments, 10.0});
  relink(map);
}

TEST(PlanarMapOf, LeavesOutWhatFewOfThoseThatLookedThereSaw) {
  for (const int keyframes : {1, 2, 4, 8}) {
    test::Random random(7);
    MapState map;
    for (int k = 0; k < keyframes; ++k)
      addKeyframe({}, bodyPose(random), k, k == 0 ? 0 : static_cast<int>(kRoom.size()), map);
    PlanarParams params;
    params.single_scan_area = 0.0;
    const std::size_t without = planarMapOf(map, SensorModel(), params).planes.size();
    EXPECT_EQ(without, kRoom.size());
    addPhantom(0, map);
    const std::size_t with = planarMapOf(map, SensorModel(), params).planes.size();
    // One of eight is less than `min_seen_share`.
    EXPECT_EQ(with, without + (keyframes < 8 ? 1 : 0)) << keyframes << " keyframes looked there";
  }
}

TEST(PlanarMapOf, LeavesOutSmallPlanesThatOneScanSaw) {
  test::Random random(8);
  MapState map;
  addKeyframe({}, bodyPose(random), 0, 0, map);
  PlanarParams params;
  params.min_seen_share = 0.0;
  params.single_scan_area = 1.0;
  addPhantom(0, map);  // of 0.64 m²
  EXPECT_EQ(planarMapOf(map, SensorModel(), params).planes.size(), kRoom.size() + 1)
      << "all of a map of one scan was seen once";
  addScan({}, bodyPose(random), 1, map);
  EXPECT_EQ(planarMapOf(map, SensorModel(), params).planes.size(), kRoom.size());
  params.single_scan_area = 0.5;
  EXPECT_EQ(planarMapOf(map, SensorModel(), params).planes.size(), kRoom.size() + 1);
}

/// A second look at the room in which the board is a landmark of its own, `offset` behind where it
/// is.
MapState seenTwice(double offset, const Eigen::Vector3d& aside, test::Random& random) {
  MapState map;
  addKeyframe({kBoard}, bodyPose(random), 0, 0, map);
  test::Rectangle again = kBoard;
  again.half_u *= 0.5;
  again.half_v *= 0.5;
  again.center += aside - offset * kBoard.plane().normal();
  addKeyframe({again}, bodyPose(random), 1, static_cast<int>(kRoom.size()), map);
  return map;
}

TEST(MergeCovered, JoinsWhatIsSeenWhereAnotherLandmarkWas) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    test::Random random(seed);
    const std::size_t landmarks = kRoom.size() + 2;
    MapState same = seenTwice(2.0 * kSigma, Eigen::Vector3d::Zero(), random);
    ASSERT_EQ(same.landmarks.planes.size(), landmarks);
    const Plane plane = same.landmarks.planes[kRoom.size()].plane_in_map;
    EXPECT_EQ(mergeCovered(same, kCell), 1) << "seed " << seed;
    EXPECT_EQ(same.landmarks.planes[kRoom.size()].observations.size(), 2U);
    EXPECT_TRUE(same.landmarks.planes[kRoom.size() + 1].observations.empty());
    EXPECT_EQ(same.landmarks.planes[kRoom.size()].plane_in_map.d(), plane.d());
    EXPECT_EQ(mergeCovered(same, kCell), 0);

    MapState behind = seenTwice(10.0 * kSigma, Eigen::Vector3d::Zero(), random);
    EXPECT_EQ(mergeCovered(behind, kCell), 0) << "a layer, seed " << seed;
    MapState beside = seenTwice(0.0, {0.0, 0.7, 0.0}, random);
    EXPECT_EQ(mergeCovered(beside, kCell), 0) << "where nothing was seen, seed " << seed;
  }
}

}  // namespace
}  // namespace opp::mapping
