// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/join_maps.h"

#include "opp/mapping/core/se3.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

/// Keyframes that each see one plane of their own and are linked one after the other.
MapState randomMap(test::Random& random, int keyframes) {
  MapState map;
  for (int k = 0; k < keyframes; ++k) {
    Keyframe keyframe;
    keyframe.map_from_body = random.pose(3.0);
    keyframe.landmark_of_plane = {k};
    map.keyframes.push_back(keyframe);
    map.landmarks.planes.push_back(
        {Plane::fromPointNormal(random.vector(3.0), random.unitVector()), {{k, 0}}});
    map.factors.planes.push_back({k, k, {}, 10.0});
    map.scans.push_back({0.1 * k, 0, static_cast<std::size_t>(k), k, random.pose(1.0)});
    map.scans.back().open.emplace().next = k == 0 ? -1 : k - 1;
    map.scans.back().open->gain = random.uniform(0.0, 1.0) * Matrix6d::Identity();
    if (k == 0) continue;
    map.links.push_back({k - 1, k, 0.01});
    map.factors.relative_poses.push_back(
        {k - 1, k, Eigen::Isometry3d::Identity(), Matrix6d::Zero(), false});
    map.factors.orthogonalities.push_back({{k - 1, k}});
    map.factors.parallelisms.push_back({{k - 1, k}});
  }
  map.landmarks.corners.push_back({{0, 1, 2}, random.vector(3.0), {{1, 0}}});
  map.loop_closures = 1;
  return map;
}

TEST(AppendMap, MovesAndRenumbersEverything) {
  test::Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const MapState first = randomMap(random, 4), other = randomMap(random, 3);
    const Eigen::Isometry3d first_from_other = random.pose(5.0);
    MapState map = first;
    appendMap(first_from_other, MapState(other), map);
    ASSERT_EQ(map.keyframes.size(), 7U);
    EXPECT_EQ(map.loop_closures, 2U);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t id = 4 + k;
      EXPECT_LT(difference(first_from_other * other.keyframes[k].map_from_body,
                           map.keyframes[id].map_from_body)
                    .norm(),
                1e-9);
      EXPECT_EQ(map.keyframes[id].landmark_of_plane[0], static_cast<int>(id));
      EXPECT_EQ(map.landmarks.planes[id].observations[0].keyframe, static_cast<int>(id));
      EXPECT_EQ(map.factors.planes[id].keyframe, static_cast<int>(id));
      EXPECT_EQ(map.factors.planes[id].landmark, static_cast<int>(id));
      EXPECT_EQ(map.scans[id].keyframe, static_cast<int>(id));
      EXPECT_LT(
          difference(first_from_other * poseOf(other, other.scans[k]), poseOf(map, map.scans[id]))
              .norm(),
          1e-9);
      // A plane seen from a keyframe is where it was.
      const Plane before = transformed(other.keyframes[k].map_from_body.inverse(),
                                       other.landmarks.planes[k].plane_in_map);
      const Plane after = transformed(map.keyframes[id].map_from_body.inverse(),
                                      map.landmarks.planes[id].plane_in_map);
      EXPECT_LT((before.coefficients() - after.coefficients()).norm(), 1e-9);
    }
    EXPECT_EQ(map.links.back().second, 6);
    EXPECT_EQ(map.factors.relative_poses.back().second, 6);
    EXPECT_EQ(map.factors.orthogonalities.back().landmarks, (std::array<int, 2>{5, 6}));
    EXPECT_EQ(map.factors.parallelisms.back().landmarks, (std::array<int, 2>{5, 6}));
    EXPECT_EQ(map.landmarks.corners.back().planes, (std::array<int, 3>{4, 5, 6}));
    EXPECT_EQ(map.landmarks.corners.back().observations[0].keyframe, 5);
  }
}

TEST(AppendMap, OfAnEmptyMapChangesNothing) {
  test::Random random(2);
  MapState map = randomMap(random, 3);
  appendMap(random.pose(1.0), MapState(), map);
  EXPECT_EQ(map.keyframes.size(), 3U);
  EXPECT_EQ(map.scans.size(), 3U);
}

}  // namespace
}  // namespace opp::mapping
