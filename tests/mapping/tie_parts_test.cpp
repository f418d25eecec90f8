// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/tie_parts.h"

#include "opp/mapping/loop/split_map.h"
#include "opp/mapping/loop/tied_sets.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace opp::mapping {
namespace {

constexpr double kStrong = 1e-4, kLoose = 0.25, kLimit = 0.04;  // m²

/// Keyframes of one scan each, tied each to the next; loosely after those of `loose`.
MapState chain(int keyframes, const std::vector<int>& loose, test::Random& random) {
  MapState map;
  for (int k = 0; k < keyframes; ++k) {
    Keyframe keyframe;
    keyframe.features.scan_index = static_cast<std::size_t>(k);
    keyframe.map_from_body = k == 0 ? Eigen::Isometry3d::Identity() : random.pose(2.0);
    keyframe.view_centre_in_body = Eigen::Vector3d::UnitX();
    map.keyframes.push_back(keyframe);
    map.scans.push_back({0.1 * k, 0, std::size_t(k), k, Eigen::Isometry3d::Identity()});
    if (k == 0) continue;
    const bool open = std::count(loose.begin(), loose.end(), k - 1) > 0;
    map.links.push_back({k - 1, k, open ? kLoose : kStrong});
    map.factors.relative_poses.push_back(
        {k - 1, k,
         map.keyframes[std::size_t(k) - 1].map_from_body.inverse() * keyframe.map_from_body,
         Matrix6d::Identity() / (open ? kLoose : kStrong)});
  }
  return map;
}

/// Each part in a frame of its own, as when it has joined another.
std::vector<MapPart> takenAsunder(MapState map, test::Random& random) {
  PartHistory history;
  history.origins = {0};
  const std::vector<int> sets = tiedSets(map, kLimit);
  history.expectTied(map, sets);
  std::vector<MapPart> parts;
  for (MapState& piece : splitMap(std::move(map), sets)) {
    const Eigen::Isometry3d moved =
        parts.empty() ? Eigen::Isometry3d::Identity() : random.pose(5.0);
    for (Keyframe& k : piece.keyframes) k.map_from_body = moved * k.map_from_body;
    parts.emplace_back(static_cast<int>(parts.size()), LoopParams());
    parts.back().history = history;
    parts.back().map = std::move(piece);
    parts.back().indexFrom(0);
  }
  return parts;
}

TEST(TieParts, UndoesASplit) {
  test::Random random(1);
  for (const std::vector<int>& loose : {std::vector<int>{2}, {1, 4}, {0, 1, 5}}) {
    const MapState map = chain(7, loose, random);
    std::vector<MapPart> parts = takenAsunder(map, random);
    ASSERT_EQ(parts.size(), loose.size() + 1);
    std::rotate(parts.begin() + 1, parts.begin() + 2, parts.end());  // the next need not come next
    EXPECT_TRUE(tieParts(parts));
    ASSERT_EQ(parts.size(), 1U);
    const MapState& tied = parts.front().map;
    ASSERT_EQ(tied.keyframes.size(), map.keyframes.size());
    EXPECT_EQ(parts.front().index.size(), 7);
    EXPECT_EQ(tied.factors.relative_poses.size(), map.factors.relative_poses.size());
    for (const Keyframe& keyframe : tied.keyframes) {
      const Keyframe& before = map.keyframes[keyframe.features.scan_index];
      EXPECT_TRUE(keyframe.map_from_body.isApprox(before.map_from_body, 1e-9));
    }
    const std::vector<int> sets = tiedSets(tied, kLimit);
    EXPECT_EQ(1 + *std::max_element(sets.begin(), sets.end()), static_cast<int>(loose.size()) + 1)
        << "what was loose still is";
  }
}

TEST(TieParts, LeavesApartWhatWasNeverOne) {
  test::Random random(2);
  std::vector<MapPart> parts = takenAsunder(chain(5, {2}, random), random);
  parts[1].history.origins = {1};
  EXPECT_FALSE(tieParts(parts)) << "a body that was lost between them";
  EXPECT_EQ(parts.size(), 2U);
  parts[1].history = PartHistory();
  parts[0].history.beginnings.clear();
  EXPECT_FALSE(tieParts(parts)) << "nothing ties them";
}

}  // namespace
}  // namespace opp::mapping
