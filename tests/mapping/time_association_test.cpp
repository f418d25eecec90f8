// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/time_association.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

StampedPose at(double time, double x, double yaw = 0.0) {
  StampedPose pose;
  pose.timestamp = time;
  pose.map_from_body.translation().x() = x;
  pose.map_from_body.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

TEST(PoseAt, InterpolatesLinearlyAndSpherically) {
  const Trajectory gt{at(1.0, 0.0, 0.0), at(1.08, 8.0, 0.8)};
  const auto pose = poseAt(gt, 1.02, {});
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation().x(), 2.0, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(pose->linear()).angle(), 0.2, 1e-12);
}

TEST(PoseAt, GivesATruePoseBackUnchangedAtItsTime) {
  test::Random random(61);
  Trajectory gt;
  for (int k = 0; k < 60; ++k) gt.push_back({0.05 * k, random.pose(5.0)});
  for (const StampedPose& pose : gt) {
    const auto found = poseAt(gt, pose.timestamp, {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->matrix(), pose.map_from_body.matrix());
  }
}

TEST(PoseAt, TakesTheNearestPoseAcrossAGapThatIsTooLong) {
  const AssociationParams params{0.1, 0.01};
  const Trajectory gt{at(1.0, 0.0), at(2.0, 8.0)};
  EXPECT_EQ(poseAt(gt, 1.009, params)->translation().x(), 0.0);
  EXPECT_EQ(poseAt(gt, 1.991, params)->translation().x(), 8.0);
  EXPECT_FALSE(poseAt(gt, 1.5, params));
}

TEST(PoseAt, DoesNotReachBeyondTheEndsByMoreThanTheTolerance) {
  const AssociationParams params{0.1, 0.01};
  const Trajectory gt{at(1.0, 0.0), at(1.05, 1.0)};
  EXPECT_EQ(poseAt(gt, 0.995, params)->translation().x(), 0.0);
  EXPECT_EQ(poseAt(gt, 1.055, params)->translation().x(), 1.0);
  EXPECT_FALSE(poseAt(gt, 0.98, params));
  EXPECT_FALSE(poseAt(gt, 1.07, params));
}

TEST(PoseAt, FindsNothingInAnEmptyTrajectoryOrAtNoTime) {
  EXPECT_FALSE(poseAt({}, 1.0, {}));
  EXPECT_FALSE(poseAt({at(1.0, 0.0)}, std::nan(""), {}));
}

TEST(AssociateByTime, IsExactForUniformMotionSampledAtOtherTimes) {
  test::Random random(62);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d velocity = random.vector(2.0);
    const Eigen::Vector3d axis = random.unitVector();
    const double rate = random.uniform(-3.0, 3.0);
    const auto pose_at = [&](double t) {
      StampedPose pose{t, Eigen::Isometry3d::Identity()};
      pose.map_from_body.linear() = Eigen::AngleAxisd(rate * t, axis).toRotationMatrix();
      pose.map_from_body.translation() = velocity * t;
      return pose;
    };
    Trajectory gt, est;
    for (int i = 0; i <= 100; ++i) gt.push_back(pose_at(0.01 * i));
    for (int i = 0; i < 30; ++i) est.push_back(pose_at(i / 30.0));
    const auto pairs = associateByTime(gt, est, {});
    ASSERT_EQ(pairs.size(), est.size());
    for (const PosePair& pair : pairs) {
      // Closed form: rounding of sines and of the interpolation weights.
      EXPECT_LT(
          (pair.gt_from_body.matrix() - pair.est_from_body.matrix()).lpNorm<Eigen::Infinity>(),
          1e-12);
    }
  }
}

TEST(AssociateByTime, LeavesOutPosesWithoutTruth) {
  const auto pairs = associateByTime({at(1.0, 0.0)}, {at(0.0, 5.0), at(1.0, 6.0)}, {});
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].est_from_body.translation().x(), 6.0);
}

TEST(AssociateByTime, RejectsTimesThatDoNotAscendAndBadParameters) {
  EXPECT_THROW(associateByTime({at(1.0, 0.0), at(1.0, 0.0)}, {}, {}), std::invalid_argument);
  EXPECT_THROW(associateByTime({}, {at(2.0, 0.0), at(1.0, 0.0)}, {}), std::invalid_argument);
  EXPECT_THROW(associateByTime({}, {at(std::nan(""), 0.0), at(1.0, 0.0)}, {}),
               std::invalid_argument);
  EXPECT_THROW(associateByTime({}, {}, {-1.0, 0.01}), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
