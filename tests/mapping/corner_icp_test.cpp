// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/corner_icp.h"

#include "opp/geometry/constants.h"

#include "support/random.h"
#include "support/synthetic_room.h"

#include <gtest/gtest.h>

#include <limits>

namespace opp::mapping {
namespace {

constexpr double kSpread = CornerIcpParams{}.collinear_spread;

std::vector<CornerPair> cornersOf(const std::vector<Eigen::Vector3d>& in_target,
                                  const Eigen::Isometry3d& target_from_source) {
  std::vector<CornerPair> pairs;
  for (const Eigen::Vector3d& c : in_target) pairs.push_back({c, target_from_source.inverse() * c});
  return pairs;
}

Eigen::Isometry3d disturbed(const Eigen::Isometry3d& pose, test::Random& random) {
  Vector6d omega_v;
  omega_v << random.vector(0.05), random.vector(0.05);
  return retract(pose, omega_v);
}

TEST(CornerConstraint, NumberAndSpreadOfCornersDecideTheFreeParameters) {
  const Eigen::Isometry3d same = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d a(0.0, 0.0, 0.0), b(1.0, 0.0, 0.0), c(2.0, 0.0, 0.0), d(0.0, 1.0, 0.0);
  EXPECT_EQ(cornerConstraint({}, same, kSpread).dof, 6);
  EXPECT_EQ(cornerConstraint(cornersOf({b}, same), same, kSpread).dof, 3);
  EXPECT_EQ(cornerConstraint(cornersOf({b, b}, same), same, kSpread).dof, 3);
  EXPECT_EQ(cornerConstraint(cornersOf({a, b}, same), same, kSpread).dof, 1);
  EXPECT_EQ(cornerConstraint(cornersOf({a, b, c}, same), same, kSpread).dof, 1);
  EXPECT_EQ(cornerConstraint(cornersOf({a, b, d}, same), same, kSpread).dof, 0);
}

TEST(CornerConstraint, AlwaysBringsTheCornersTogether) {
  test::Random random(1);
  for (int k = 0; k < 100; ++k) {
    const Eigen::Isometry3d truth = random.pose(3.0);
    const int count = 1 + k % 5;
    std::vector<Eigen::Vector3d> corners;
    for (int i = 0; i < count; ++i) corners.push_back(random.vector(3.0));
    const auto pairs = cornersOf(corners, truth);
    const CornerConstraint result = cornerConstraint(pairs, disturbed(truth, random), kSpread);
    // Corners that are only nearly on a line leave the turn about it to the points: off by the
    // guess's error in it (0.09 rad) times their spread across the line (0.2 m).
    const double tolerance = result.dof == 1 && count > 2 ? 0.09 * kSpread * count : 1e-9;
    for (const CornerPair& p : pairs) {
      EXPECT_LT((result.target_from_source * p.in_source - p.in_target).norm(), tolerance);
    }
    if (result.dof == 0) {
      EXPECT_TRUE(result.target_from_source.isApprox(truth, 1e-9));
    }
  }
}

TEST(CornerIcp, RecoversThePoseWithSixThreeOneAndNoFreeParameters) {
  test::Random random(2);
  const std::vector<Eigen::Vector3d> all = {{2.0, 1.5, 0.0}, {2.0, 1.5, 2.4}, {-2.0, 1.5, 0.0}};
  for (int k = 0; k < 50; ++k) {
    test::SyntheticOptions options;
    options.spacing = 0.12;
    options.seed = static_cast<std::uint64_t>(k);
    const test::Rectangles room = test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.4});
    const OrientedCloud target =
        test::sampleScene(room, {0.0, 0.0, 1.0}, Eigen::Isometry3d::Identity(), options).cloud;
    const Eigen::Isometry3d truth = random.pose(2.0);
    options.seed += 1000;
    const OrientedCloud source =
        test::sampleScene(room, {0.4, 0.2, 1.2}, truth.inverse(), options).cloud;
    const std::size_t used = static_cast<std::size_t>(k % 4);
    const std::vector<Eigen::Vector3d> corners(all.begin(), all.begin() + static_cast<int>(used));
    const CornerIcpResult result = cornerIcp(target, source, cornersOf(corners, truth),
                                             disturbed(truth, random), CornerIcpParams{});
    const std::array<int, 4> expected_dof = {6, 3, 1, 0};
    EXPECT_EQ(result.dof, expected_dof[used]);
    EXPECT_TRUE(result.converged) << k;
    const Vector6d error = difference(truth, result.target_from_source);
    // Exact planes; only float32 points and the few matches across an edge remain.
    EXPECT_LT(error.head<3>().norm(), 1e-3) << k;
    EXPECT_LT(error.tail<3>().norm(), 2e-3) << k;
    EXPECT_EQ(result.iterations == 0, result.dof == 0);
    EXPECT_GT(result.matches, 100);
  }
}

TEST(CornerIcp, StaysOnTheConstraintHoweverThePointsPull) {
  test::Random random(3);
  test::SyntheticOptions options;
  options.spacing = 0.15;
  const test::Rectangles room = test::furnishedRoom(1);
  const OrientedCloud cloud =
      test::sampleScene(room, {0.0, 0.0, 1.2}, Eigen::Isometry3d::Identity(), options).cloud;
  // Corners that contradict the points by 5 cm.
  const CornerPair corner{{1.0, 1.0, 0.0}, {1.05, 1.0, 0.0}};
  const CornerIcpResult result =
      cornerIcp(cloud, cloud, {corner}, Eigen::Isometry3d::Identity(), CornerIcpParams{});
  EXPECT_LT((result.target_from_source * corner.in_source - corner.in_target).norm(), 1e-9);
}

TEST(CornerIcp, NothingToMatchKeepsTheStart) {
  test::Random random(4);
  const Eigen::Isometry3d start = random.pose(1.0);
  const CornerIcpResult result =
      cornerIcp(OrientedCloud{}, OrientedCloud{}, {}, start, CornerIcpParams{});
  EXPECT_TRUE(result.target_from_source.isApprox(start, 1e-12));
  EXPECT_EQ(result.matches, 0);
  EXPECT_FALSE(result.converged);
  EXPECT_TRUE(result.covariance.isZero());
}

TEST(CornerIcp, RejectsParametersOutOfRange) {
  CornerIcpParams params;
  params.max_distance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(cornerIcp({}, {}, {}, Eigen::Isometry3d::Identity(), params), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
