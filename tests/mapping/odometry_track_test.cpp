// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/odometry_track.h"

#include "opp/mapping/core/se3.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

TEST(OdometryTrack, KnowsNothingWithoutARecentReading) {
  OdometryTrack track;
  EXPECT_FALSE(track.at(0.0));
  track.add(10.0, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(track.at(10.0 + OdometryTrack::kMaxAge));
  EXPECT_FALSE(track.at(10.1 + OdometryTrack::kMaxAge));
  EXPECT_FALSE(track.at(std::nan("")));
}

TEST(OdometryTrack, CarriesAConstantMotionOn) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d start = random.pose(5.0);
    const Eigen::Isometry3d step = random.motion(0.2, 0.1);
    OdometryTrack track;
    track.add(1.0, start);
    track.add(1.1, start * step);
    const Eigen::Isometry3d expected = start * step * step;
    ASSERT_TRUE(track.at(1.2));
    // 0.1 s steps are exact to 1e-15 s only, and rotations multiply up: 1e-9 is well above both.
    EXPECT_LT(difference(expected, *track.at(1.2)).norm(), 1e-9);
    EXPECT_LT(difference(start * step, *track.at(1.1)).norm(), 1e-9);
  }
}

TEST(OdometryTrack, ARepeatedStampReplacesTheReading) {
  OdometryTrack track;
  track.add(1.0, Eigen::Isometry3d::Identity());
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.translation().x() = 1.0;
  track.add(1.0, moved);
  ASSERT_TRUE(track.at(1.0));
  EXPECT_EQ(track.at(1.0)->translation().x(), 1.0);
}

}  // namespace
}  // namespace opp::mapping
