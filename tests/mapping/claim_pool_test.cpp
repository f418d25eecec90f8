// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/claim_pool.h"

#include "opp/mapping/core/se3.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

PlaceClaim claimOf(int keyframe_b, const Eigen::Isometry3d& a_from_b) {
  PlaceClaim claim;
  claim.keyframe_b = keyframe_b;
  claim.claimant = {0, static_cast<std::size_t>(keyframe_b)};
  claim.map_a_from_map_b = a_from_b;
  claim.place_in_map_b = Eigen::Vector3d(5.0, 0.0, 0.0);
  return claim;
}

Eigen::Isometry3d shifted(const Eigen::Isometry3d& pose, double x) {
  return Eigen::Translation3d(x, 0.0, 0.0) * pose;
}

TEST(ClaimPool, BelievesWhatSeveralKeyframesSay) {
  test::Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    ClaimPool pool(LoopParams(), LoopParams().confirmations);
    const Eigen::Isometry3d pose = random.pose(3.0);
    pool.add(claimOf(7, pose));
    EXPECT_TRUE(pool.agreed().empty()) << "one keyframe proves nothing";
    pool.add(claimOf(7, pose));
    EXPECT_TRUE(pool.agreed().empty()) << "the same keyframe again proves nothing";
    pool.add(claimOf(8, shifted(pose, 0.05)));
    EXPECT_EQ(pool.agreed().size(), 3U);
  }
}

TEST(ClaimPool, TwoKeyframesThatLookAtEachOtherAreOneWitness) {
  test::Random random(7);
  const Eigen::Isometry3d pose = random.pose(3.0);
  ClaimPool pool(LoopParams(), 2);
  pool.add(claimOf(7, pose));
  PlaceClaim back = claimOf(7, pose);
  back.claimant = {1, 3};
  back.b_looked = false;
  pool.add(back);
  EXPECT_TRUE(pool.agreed().empty());
  back.claimant = {1, 4};
  pool.add(back);
  EXPECT_EQ(pool.agreed().size(), 3U) << "two of the other side";
}

TEST(ClaimPool, ConfirmsWhatDifferentKeyframesSayAlike) {
  test::Random random(3);
  const Eigen::Isometry3d pose = random.pose(3.0);
  ClaimPool pool(LoopParams(), 2);
  EXPECT_TRUE(pool.confirmed().empty());
  pool.add(claimOf(1, pose));
  pool.add(claimOf(1, shifted(pose, 0.02)));
  pool.add(claimOf(2, shifted(pose, 0.5)));
  EXPECT_TRUE(pool.confirmed().empty()) << "the same keyframe twice, and one elsewhere";
  pool.add(claimOf(3, shifted(pose, -0.02)));
  const std::vector<PlaceClaim> confirmed = pool.confirmed();
  ASSERT_EQ(confirmed.size(), 3U);
  for (const PlaceClaim& claim : confirmed) EXPECT_NE(claim.keyframe_b, 2);
}

TEST(ClaimPool, IsSilentWhereKeyframesContradictEachOther) {
  ClaimPool pool(LoopParams(), LoopParams().confirmations);
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const int keyframe : {1, 2}) {
    pool.add(claimOf(keyframe, pose));
    pool.add(claimOf(keyframe, shifted(pose, 4.0)));  // the next room of the corridor
  }
  EXPECT_TRUE(pool.agreed().empty());
  pool.add(claimOf(3, pose));
  EXPECT_TRUE(pool.agreed().empty()) << "three against two is not twice as many";
  pool.add(claimOf(4, pose));
  EXPECT_EQ(pool.agreed().size(), 4U);
}

TEST(ClaimPool, OneKeyframeIsEnoughIfNoOtherPoseComesNear) {
  test::Random random(4);
  const Eigen::Isometry3d pose = random.pose(3.0);
  for (const double clarity : {0.8, 0.9}) {
    ClaimPool pool(LoopParams(), LoopParams().confirmations);
    PlaceClaim claim = claimOf(1, pose);
    claim.clarity = clarity;
    pool.add(claim);
    EXPECT_EQ(pool.agreed().size(), clarity > LoopParams().certain_clarity ? 1U : 0U);
    pool.add(claimOf(2, shifted(pose, 1.0)));
    EXPECT_TRUE(pool.agreed().empty()) << "another keyframe denies it";
  }
}

TEST(ClaimPool, ErrorsThatDoNotAgreeAreNoRivals) {
  test::Random random(2);
  ClaimPool pool(LoopParams(), LoopParams().confirmations);
  const Eigen::Isometry3d pose = random.pose(3.0);
  for (int keyframe = 0; keyframe < 10; ++keyframe) pool.add(claimOf(keyframe, random.pose(3.0)));
  EXPECT_TRUE(pool.agreed().empty());
  pool.add(claimOf(10, pose));
  pool.add(claimOf(11, pose));
  EXPECT_EQ(pool.agreed().size(), 2U);
}

TEST(PlaceClaim, SeenFromOtherIsTheSameMeasurement) {
  test::Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    PlaceClaim claim = claimOf(1, random.pose(3.0));
    claim.keyframe_a_from_b = random.pose(3.0);
    Matrix6d root;
    Vector6d step;
    for (int i = 0; i < 6; ++i) {
      step[i] = 1e-6 * random.uniform(-1.0, 1.0);
      for (int j = 0; j < 6; ++j) root(i, j) = random.uniform(-1.0, 1.0);
    }
    claim.information = root * root.transpose();
    const PlaceClaim other = seenFromOther(claim);
    // A pose that is a little off costs as much from either side.
    const Eigen::Isometry3d off = retract(claim.keyframe_a_from_b, step);
    const Vector6d step_of_other = difference(other.keyframe_a_from_b, off.inverse());
    const double cost = step.dot(claim.information * step);
    EXPECT_NEAR(step_of_other.dot(other.information * step_of_other) / cost, 1.0, 1e-4);
    const PlaceClaim back = seenFromOther(other);
    EXPECT_LT((back.information - claim.information).norm(), 1e-9 * claim.information.norm());
    EXPECT_TRUE(back.keyframe_a_from_b.isApprox(claim.keyframe_a_from_b, 1e-12));
    EXPECT_TRUE(back.map_a_from_map_b.isApprox(claim.map_a_from_map_b, 1e-12));
    EXPECT_TRUE(back.place_in_map_b.isApprox(claim.place_in_map_b, 1e-12));
    EXPECT_EQ(back.keyframe_b, 1);
  }
}

TEST(ClaimPool, ComparesPosesWhereTheClaimWasMade) {
  // 1.5° are within the tolerance of the rotation but move a place 5 m away by 13 cm.
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(degToRad(1.5), Eigen::Vector3d::UnitZ()));
  ClaimPool pool(LoopParams(), LoopParams().confirmations);
  pool.add(claimOf(1, Eigen::Isometry3d::Identity()));
  pool.add(claimOf(2, turn));
  EXPECT_TRUE(pool.agreed().empty());
}

TEST(ClaimPool, ForgetsWhatItIsTold) {
  const auto old = [](const PlaceClaim& claim) { return claim.keyframe_b < 2; };
  ClaimPool pool(LoopParams(), LoopParams().confirmations);
  pool.add(claimOf(1, Eigen::Isometry3d::Identity()));
  pool.forget(old);
  EXPECT_TRUE(pool.empty());
  pool.add(claimOf(2, Eigen::Isometry3d::Identity()));
  pool.forget(old);
  EXPECT_FALSE(pool.empty());
}

}  // namespace
}  // namespace opp::mapping
