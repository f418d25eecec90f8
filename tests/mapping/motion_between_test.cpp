// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/motion_between.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

/// Standard deviations of what is expected [rad], [m].
constexpr double kTurn = 0.05, kShift = 0.3;

/// Two scans, ten seconds apart, at random poses.
MapPart partWith(std::size_t first, test::Random& random) {
  MapPart part(static_cast<int>(first), LoopParams());
  part.map.keyframes.resize(1);
  for (const std::size_t scan : {first, first + 1})
    part.map.scans.push_back({10.0 * static_cast<double>(scan), 0, scan, 0, random.pose(2.0)});
  return part;
}

Eigen::Isometry3d lastOf(const MapPart& part) { return poseOf(part.map, part.map.scans.back()); }
Eigen::Isometry3d firstOf(const MapPart& part) { return poseOf(part.map, part.map.scans.front()); }

ExpectedBeginning expectedBetween(const MapPart& earlier, const MapPart& later,
                                  const Eigen::Isometry3d& last_from_first) {
  Vector6d variance;
  variance << Eigen::Vector3d::Constant(kTurn * kTurn), Eigen::Vector3d::Constant(kShift * kShift);
  return {earlier.map.scans.back().id(), later.map.scans.front().id(), last_from_first,
          variance.cwiseInverse().asDiagonal()};
}

/// Three parts, each of which begins where the one before lets expect.
struct Chain {
  explicit Chain(std::uint64_t seed) {
    test::Random random(seed);
    for (const std::size_t first : {0U, 2U, 4U}) parts.push_back(partWith(first, random));
    for (int k : {0, 1}) expected[k] = random.pose(2.0);
    for (std::size_t k : {0U, 1U})
      parts[k + 1].history.beginnings = {expectedBetween(parts[k], parts[k + 1], expected[k])};
  }

  /// Pose of the last part in the first if the ways between were these.
  Eigen::Isometry3d firstFromLast(const Eigen::Isometry3d& way_0,
                                  const Eigen::Isometry3d& way_1) const {
    return lastOf(parts[0]) * way_0 * firstOf(parts[1]).inverse() * lastOf(parts[1]) * way_1 *
           firstOf(parts[2]).inverse();
  }

  std::vector<MapPart> parts;
  Eigen::Isometry3d expected[2];
};

TEST(MotionBetween, ChainsExpectationsThroughAPartBetween) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Chain chain(seed);
    const MotionBetween motion(chain.parts, 0, 2, MapperParams());
    EXPECT_TRUE(motion.allows(chain.firstFromLast(chain.expected[0], chain.expected[1])));
  }
}

TEST(MotionBetween, ErrorsOfAChainAreAsLargeAsThoseOfItsWaysTogether) {
  // Denied as rarely as it should be, and a shift by seven standard deviations nearly always.
  MapperParams params;
  params.loop.agree_translation = params.loop.agree_rotation = 1e-4;
  int allowed = 0, allowed_aside = 0;
  constexpr int kSeeds = 300;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Chain chain(seed);
    test::Random random(1000 + seed);
    Eigen::Isometry3d ways[2];
    for (int k : {0, 1}) {
      Vector6d error;
      for (int i = 0; i < 6; ++i) error[i] = random.normal() * (i < 3 ? kTurn : kShift);
      ways[k] = retract(chain.expected[k], error);
    }
    const MotionBetween motion(chain.parts, 0, 2, params);
    allowed += motion.allows(chain.firstFromLast(ways[0], ways[1])) ? 1 : 0;
    Eigen::Isometry3d aside = chain.expected[0];
    aside.translation().z() += 10.0 * kShift;
    allowed_aside += motion.allows(chain.firstFromLast(aside, ways[1])) ? 1 : 0;
  }
  // P(χ² of three numbers <= 9.2) = .973, and nearly no pose beyond fails the limit of six.
  EXPECT_NEAR(static_cast<double>(allowed) / kSeeds, 0.973, 0.03);
  EXPECT_LT(static_cast<double>(allowed_aside) / kSeeds, 0.03);
}

TEST(MotionBetween, ExpectsOnlyWhatItTellsWellEnough) {
  for (const double sigma : {0.3, 1.0}) {
    Chain chain(5);
    chain.parts[1].history.beginnings.front().information.bottomRightCorner<3, 3>() =
        Eigen::Matrix3d::Identity() / (sigma * sigma);
    const MotionBetween motion(chain.parts, 0, 1, MapperParams());
    Eigen::Isometry3d way = chain.expected[0];
    const auto pose = [&] {
      return Eigen::Isometry3d(lastOf(chain.parts[0]) * way * firstOf(chain.parts[1]).inverse());
    };
    // Three standard deviations within 2 m.
    EXPECT_EQ(motion.expects(pose()), sigma < 0.66);
    EXPECT_TRUE(motion.allows(pose()));
    way.translation().x() += 4.0;
    EXPECT_FALSE(motion.expects(pose()));
  }
  Chain silent(5);
  for (MapPart& part : silent.parts) part.history.beginnings.clear();
  EXPECT_FALSE(MotionBetween(silent.parts, 0, 1, MapperParams())
                   .expects(lastOf(silent.parts[0]) * silent.expected[0] *
                            firstOf(silent.parts[1]).inverse()));
}

TEST(MotionBetween, IsNoFinerThanClaimsAre) {
  Chain chain(3);
  chain.parts[1].history.beginnings.front().information *= 1e6;
  const MotionBetween motion(chain.parts, 0, 1, MapperParams());
  for (const double off : {0.05, 1.0}) {
    Eigen::Isometry3d way = chain.expected[0];
    way.translation().x() += off;
    EXPECT_EQ(motion.allows(lastOf(chain.parts[0]) * way * firstOf(chain.parts[1]).inverse()),
              off < 0.1);
  }
}

TEST(MotionBetween, WithoutExpectationsOnlyTheSpeedCounts) {
  Chain chain(7);
  for (MapPart& part : chain.parts) part.history.beginnings.clear();
  const MotionBetween motion(chain.parts, 0, 1, MapperParams());
  const Eigen::Isometry3d there =
      lastOf(chain.parts[0]) * firstOf(chain.parts[1]).inverse();  // it has not moved at all
  // 2 m and thrice 1 m/s for 10 s.
  for (const double way : {31.0, 33.0}) {
    Eigen::Isometry3d aside = there;
    aside.translation().x() += way;
    EXPECT_EQ(motion.allows(aside), way < 32.0);
    EXPECT_EQ(MotionBetween(chain.parts, 1, 0, MapperParams()).allows(aside.inverse()), way < 32.0);
  }
}

}  // namespace
}  // namespace opp::mapping
