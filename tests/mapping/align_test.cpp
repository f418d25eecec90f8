// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/align.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <limits>

namespace opp::mapping {
namespace {

/// Pairs whose estimate is the truth seen from another frame.
std::vector<PosePair> seenFrom(const Eigen::Isometry3d& est_from_gt,
                               const std::vector<Eigen::Isometry3d>& gt_from_body) {
  std::vector<PosePair> pairs;
  for (const Eigen::Isometry3d& pose : gt_from_body) {
    pairs.push_back({static_cast<double>(pairs.size()), pose, est_from_gt * pose});
  }
  return pairs;
}

double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).lpNorm<Eigen::Infinity>();
}

double squaredPositionError(const std::vector<PosePair>& pairs,
                            const Eigen::Isometry3d& gt_from_est) {
  double sum = 0.0;
  for (const PosePair& p : pairs) {
    sum +=
        (p.gt_from_body.translation() - gt_from_est * p.est_from_body.translation()).squaredNorm();
  }
  return sum;
}

// Singular vectors of well-conditioned covariances are exact to rounding, amplified by the ratio of
// the singular values and by coordinates of tens of metres.
constexpr double kClosedForm = 1e-10;

TEST(Align, NoPairsGiveIdentity) {
  EXPECT_EQ(alignTrajectories({}).matrix(), Eigen::Matrix4d::Identity());
}

TEST(Align, OnePairIsAlignedExactly) {
  test::Random random(51);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d est_from_gt = random.pose(10.0);
    const auto pairs = seenFrom(est_from_gt, {random.pose(10.0)});
    EXPECT_LT(distance(alignTrajectories(pairs), est_from_gt.inverse()), kClosedForm);
  }
}

TEST(Align, RestingBodyIsAlignedByItsOrientations) {
  test::Random random(52);
  for (int k = 0; k < 50; ++k) {
    std::vector<Eigen::Isometry3d> poses(5, random.pose(10.0));
    for (auto& pose : poses) pose.linear() = random.rotation();
    const Eigen::Isometry3d est_from_gt = random.pose(10.0);
    EXPECT_LT(distance(alignTrajectories(seenFrom(est_from_gt, poses)), est_from_gt.inverse()),
              kClosedForm);
  }
}

TEST(Align, StraightPathsAreTurnedByTheirOrientations) {
  test::Random random(53);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d direction = random.unitVector();
    const Eigen::Vector3d start = random.vector(10.0);
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < 6; ++i) {
      poses.push_back(random.pose(1.0));
      poses.back().translation() = start + 0.7 * i * direction;
    }
    const Eigen::Isometry3d est_from_gt = random.pose(10.0);
    EXPECT_LT(distance(alignTrajectories(seenFrom(est_from_gt, poses)), est_from_gt.inverse()),
              kClosedForm);
  }
}

TEST(Align, RecoversTheFrameOfAnyPath) {
  test::Random random(54);
  for (int k = 0; k < 100; ++k) {
    std::vector<Eigen::Isometry3d> poses;
    const int count = random.integer(3, 30);
    for (int i = 0; i < count; ++i) poses.push_back(random.pose(10.0));
    const Eigen::Isometry3d est_from_gt = random.pose(100.0);
    EXPECT_LT(distance(alignTrajectories(seenFrom(est_from_gt, poses)), est_from_gt.inverse()),
              kClosedForm);
  }
}

TEST(Align, PlanarPathsStayRightHanded) {
  test::Random random(55);
  for (int k = 0; k < 50; ++k) {
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < 8; ++i) {
      poses.push_back(random.pose(5.0));
      poses.back().translation().z() = 1.5;
    }
    const Eigen::Isometry3d est_from_gt = random.pose(10.0);
    const Eigen::Isometry3d result = alignTrajectories(seenFrom(est_from_gt, poses));
    EXPECT_LT(distance(result, est_from_gt.inverse()), kClosedForm);
  }
}

TEST(Align, MirroredPathsGiveARotationNotAReflection) {
  std::vector<PosePair> pairs;
  test::Random random(56);
  for (int i = 0; i < 8; ++i) {
    PosePair pair;
    pair.gt_from_body.translation() = random.vector(2.0);
    pair.est_from_body.translation() = pair.gt_from_body.translation();
    pair.est_from_body.translation().x() *= -1.0;
    pairs.push_back(pair);
  }
  EXPECT_NEAR(alignTrajectories(pairs).linear().determinant(), 1.0, 1e-12);
}

TEST(Align, NoNearbyMotionFitsBetter) {
  test::Random random(57);
  for (int k = 0; k < 50; ++k) {
    std::vector<PosePair> pairs;
    const Eigen::Isometry3d est_from_gt = random.pose(5.0);
    for (int i = 0; i < 10; ++i) {
      PosePair pair{0.1 * i, random.pose(3.0), Eigen::Isometry3d::Identity()};
      pair.est_from_body = est_from_gt * pair.gt_from_body * random.motion(0.1, 0.2);
      pairs.push_back(pair);
    }
    const Eigen::Isometry3d best = alignTrajectories(pairs);
    const double least = squaredPositionError(pairs, best);
    for (int i = 0; i < 20; ++i) {
      EXPECT_LE(least, squaredPositionError(pairs, best * random.motion(0.01, 0.01)) + 1e-12);
    }
  }
}

TEST(AlignPoses, RecoversTheFrameOfAnyPathRestingAndStraightOnesToo) {
  test::Random random(58);
  for (int k = 0; k < 60; ++k) {
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < 8; ++i) {
      poses.push_back(random.pose(10.0));
      if (k % 3 == 1) poses.back().translation() = Eigen::Vector3d(1, 2, 3);
      if (k % 3 == 2) poses.back().translation() = i * Eigen::Vector3d(1, 2, 3);
    }
    const Eigen::Isometry3d est_from_gt = random.pose(10.0);
    EXPECT_LT(distance(alignPoses(seenFrom(est_from_gt, poses)), est_from_gt.inverse()),
              kClosedForm);
  }
  EXPECT_EQ(alignPoses({}).matrix(), Eigen::Matrix4d::Identity());
}

TEST(AlignPoses, FindsRotationOfShortPathsBetterThanPositionsAlone) {
  // 100 poses within 0.2 m, position noise 1 cm, orientation noise 1 mrad an axis. Positions alone
  // see the rotation to about 0.01/(0.12·√100) = 8 mrad; the mean orientation to 0.1 mrad an axis.
  test::Random random(59);
  double positions = 0.0;
  double both = 0.0;
  for (int k = 0; k < 50; ++k) {
    std::vector<PosePair> pairs;
    for (int i = 0; i < 100; ++i) {
      PosePair pair{0.1 * i, random.pose(0.1), Eigen::Isometry3d::Identity()};
      Eigen::Vector3d turn(random.normal(1e-3), random.normal(1e-3), random.normal(1e-3));
      Eigen::Vector3d shift(random.normal(0.01), random.normal(0.01), random.normal(0.01));
      pair.est_from_body.linear() =
          pair.gt_from_body.linear() * Eigen::AngleAxisd(turn.norm(), turn.normalized());
      pair.est_from_body.translation() = pair.gt_from_body.translation() + shift;
      pairs.push_back(pair);
    }
    positions += Eigen::AngleAxisd(alignTrajectories(pairs).linear()).angle() / 50;
    both += Eigen::AngleAxisd(alignPoses(pairs).linear()).angle() / 50;
  }
  EXPECT_GT(positions, 5e-3);
  EXPECT_LT(both, 3e-4);  // mean length of three axes of 0.1 mrad each: 0.16 mrad
}

TEST(Align, RejectsPosesThatAreNotFinite) {
  PosePair pair;
  pair.est_from_body.translation().y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(alignTrajectories({pair}), std::invalid_argument);
  EXPECT_THROW(alignPoses({pair}), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
