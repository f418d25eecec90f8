// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/constellation.h"

#include "support/random.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

constexpr double kWidth = 0.05;

Primitives roomFrom(std::uint64_t room, const Eigen::Vector3d& viewpoint,
                    const Eigen::Isometry3d& body_from_scene) {
  test::SyntheticOptions options;
  options.spacing = 0.08;
  return test::truePrimitives(
      test::sampleScene(test::furnishedRoom(room), viewpoint, body_from_scene, options));
}

TEST(Constellation, OfNothingIsEmpty) {
  EXPECT_TRUE(constellationOf(Primitives(), kWidth).empty());
  ConstellationIndex index(kWidth);
  index.add(Primitives());
  EXPECT_EQ(index.likeness(Primitives()), std::vector<double>{0.0});
}

TEST(Constellation, DoesNotDependOnThePose) {
  test::Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const auto room = static_cast<std::uint64_t>(trial);
    const Eigen::Vector3d viewpoint(0.0, 0.0, 1.2);
    ConstellationIndex index(kWidth);
    index.add(roomFrom(room, viewpoint, Eigen::Isometry3d::Identity()));
    const auto likeness = index.likeness(roomFrom(room, viewpoint, random.pose(10.0)));
    EXPECT_GT(likeness[0], 0.9);  // 1 but for corners that flicker at the edge of their support
  }
}

TEST(ConstellationIndex, FindsTheRoomAmongOthers) {
  test::Random random(2);
  ConstellationIndex index(kWidth);
  for (std::uint64_t room = 0; room < 10; ++room) {
    index.add(roomFrom(room, {0.0, 0.0, 1.2}, Eigen::Isometry3d::Identity()));
  }
  int first = 0;
  for (int room = 0; room < 10; ++room) {
    const auto seen = roomFrom(static_cast<std::uint64_t>(room), {0.5, 0.3, 1.5}, random.pose(5.0));
    const std::vector<double> likeness = index.likeness(seen);
    const auto best = std::max_element(likeness.begin(), likeness.end()) - likeness.begin();
    first += best == room ? 1 : 0;
  }
  // From another viewpoint other furniture may be hidden; most rooms are still told apart.
  EXPECT_GE(first, 8);
}

}  // namespace
}  // namespace opp::mapping
