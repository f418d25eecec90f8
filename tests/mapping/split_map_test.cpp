// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/split_map.h"

#include "opp/mapping/loop/tied_sets.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace opp::mapping {
namespace {

constexpr double kStrong = 1e-4, kLoose = 0.25, kLimit = 0.04;  // m²

Matrix6d informationWithout(int direction) {
  Matrix6d information = 1e6 * Matrix6d::Identity();
  if (direction >= 0) information(direction, direction) = 0.0;
  return information;
}

/// Keyframes in a row, each with a plane of its own, and landmark 0 that all of them see. The links
/// after `loose` leave one direction open.
MapState row(int keyframes, const std::vector<int>& loose, int direction) {
  MapState map;
  map.landmarks.planes.push_back(
      {Plane::fromPointNormal(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()), {}});
  for (int k = 0; k < keyframes; ++k) {
    Keyframe keyframe;
    keyframe.map_from_body.translation().x() = k;
    keyframe.landmark_of_plane = {0, k + 1};
    map.keyframes.push_back(keyframe);
    map.landmarks.planes[0].observations.push_back({k, 0});
    map.landmarks.planes.push_back(
        {Plane::fromPointNormal(Eigen::Vector3d(k, 0.0, 0.0), Eigen::Vector3d::UnitX()), {{k, 1}}});
    map.factors.planes.push_back({k, 0, {}, 10.0});
    map.factors.planes.push_back({k, k + 1, {}, 10.0});
    map.scans.push_back({0.1 * k, 0, std::size_t(2 * k), k, Eigen::Isometry3d::Identity()});
    if (k + 1 < keyframes) map.scans.back().open.emplace().next = k + 1;
    map.factors.orthogonalities.push_back({{0, k + 1}});
    if (k == 0) continue;
    const bool open = std::count(loose.begin(), loose.end(), k - 1) > 0;
    Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
    step.translation().x() = 1.0;
    map.links.push_back({k - 1, k, open ? kLoose : kStrong});
    map.factors.relative_poses.push_back(
        {k - 1, k, step, informationWithout(open ? direction : -1)});
    map.factors.parallelisms.push_back({{k, k + 1}});
  }
  map.landmarks.corners.push_back({{0, 1, 2}, Eigen::Vector3d::Zero(), {{0, 0}, {1, 0}}});
  map.loop_closures = 3;
  return map;
}

std::vector<MapState> split(MapState&& map) {
  const std::vector<int> sets = tiedSets(map, kLimit);
  return splitMap(std::move(map), sets);
}

TEST(SplitMap, LeavesAWellTiedMapAsItIs) {
  const std::vector<MapState> parts = split(row(5, {}, 0));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].keyframes.size(), 5U);
  EXPECT_EQ(parts[0].loop_closures, 3U);
  EXPECT_TRUE(split(MapState()).empty());
}

TEST(SplitMap, CutsWhereADirectionIsOpen) {
  for (int direction = 0; direction < 6; ++direction) {
    const std::vector<MapState> parts = split(row(5, {1}, direction));
    ASSERT_EQ(parts.size(), 2U) << "direction " << direction;
    EXPECT_EQ(parts[0].keyframes.size(), 2U);
    const MapState& second = parts[1];
    ASSERT_EQ(second.keyframes.size(), 3U);
    EXPECT_EQ(parts[0].loop_closures, 0U);
    EXPECT_EQ(second.loop_closures, 3U);
    EXPECT_DOUBLE_EQ(second.keyframes[0].map_from_body.translation().x(), 2.0);
    ASSERT_EQ(second.landmarks.planes.size(), 4U) << "that of all and one of each";
    EXPECT_EQ(second.landmarks.planes[0].observations.size(), 3U);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(second.keyframes[std::size_t(k)].landmark_of_plane, (std::vector<int>{0, k + 1}));
      EXPECT_EQ(second.landmarks.planes[std::size_t(k + 1)].observations[0].keyframe, k);
      EXPECT_EQ(second.scans[std::size_t(k)].keyframe, k);
      EXPECT_EQ(second.scans[std::size_t(k)].scan_index, std::size_t(2 * k + 4));
    }
    EXPECT_EQ(parts[0].scans[0].open->next, 1);
    EXPECT_EQ(parts[0].scans[1].open->next, -1) << "which went to the other part";
    EXPECT_EQ(second.scans[0].open->next, 1);
    EXPECT_EQ(second.links.size(), 2U);
    EXPECT_EQ(second.factors.planes.size(), 6U);
    EXPECT_EQ(second.factors.relative_poses.size(), 2U);
    EXPECT_EQ(second.factors.orthogonalities.size(), 3U);
    EXPECT_EQ(second.factors.parallelisms.back().landmarks, (std::array<int, 2>{2, 3}));
    EXPECT_TRUE(second.landmarks.corners.empty());
    ASSERT_EQ(parts[0].landmarks.corners.size(), 1U);
    EXPECT_EQ(parts[0].landmarks.corners[0].observations.size(), 2U);
  }
}

TEST(SplitMap, TwoLooseTiesHoldIfTheyLeaveDifferentDirectionsOpen) {
  for (int first = 3; first < 6; ++first) {
    for (int second = 3; second < 6; ++second) {
      // A ring: 0 and 1 are tied to 2, 3, 4 by the steps after 1 and from 4 back to 0.
      MapState map = row(5, {1}, first);
      map.links.push_back({4, 0, kLoose});
      Eigen::Isometry3d back = Eigen::Isometry3d::Identity();
      back.translation().x() = -4.0;
      map.factors.relative_poses.push_back({4, 0, back, informationWithout(second)});
      const std::size_t expected = first == second ? 2 : 1;
      EXPECT_EQ(split(std::move(map)).size(), expected) << first << " " << second;
    }
  }
}

TEST(SplitMap, ATurnLeftOpenIsFixedByTwoPointsFarApart) {
  // Neither tie knows the turn about z; two of them two metres apart do.
  MapState map = row(5, {1}, 2);
  map.links.push_back({4, 0, kLoose});
  Eigen::Isometry3d back = Eigen::Isometry3d::Identity();
  back.translation().x() = -4.0;
  map.factors.relative_poses.push_back({4, 0, back, informationWithout(2)});
  EXPECT_EQ(split(std::move(map)).size(), 1U);
}

}  // namespace
}  // namespace opp::mapping
