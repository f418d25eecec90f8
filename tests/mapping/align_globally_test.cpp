// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/align_globally.h"

#include "opp/geometry/constants.h"

#include "support/random.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

test::SyntheticOptions options(double sigma, std::uint64_t seed) {
  test::SyntheticOptions result;
  result.spacing = 0.08;
  result.sigma = sigma;
  result.seed = seed;
  return result;
}

ScanFeatures see(const test::Rectangles& scene, const Eigen::Vector3d& eye,
                 const Eigen::Isometry3d& body_from_scene, double sigma, std::uint64_t seed) {
  return test::trueFeatures(test::sampleScene(scene, eye, body_from_scene, options(sigma, seed)));
}

void expectPose(const GlobalAlignment& result, const Eigen::Isometry3d& truth, double angle,
                double distance, std::uint64_t seed) {
  ASSERT_EQ(result.outcome, AlignmentOutcome::kAligned)
      << "seed " << seed << ": " << describe(result.outcome) << ", overlap " << result.overlap
      << ", dof " << result.observed_dof << ", clarity " << result.clarity;
  const Vector6d error = difference(truth, result.target_from_source);
  EXPECT_LT(error.head<3>().norm(), angle) << "seed " << seed;
  EXPECT_LT(error.tail<3>().norm(), distance) << "seed " << seed;
}

TEST(AlignGlobally, FindsAnyPoseBetweenTwoViewsOfAFurnishedRoom) {
  test::Random random(1);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const test::Rectangles room = test::furnishedRoom(seed);
    const Eigen::Vector3d eye_t(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), 1.3);
    const Eigen::Vector3d eye_s(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), 1.2);
    const Eigen::Isometry3d target_from_scene = random.pose(3.0),
                            source_from_scene = random.pose(3.0);
    const ScanFeatures target = see(room, eye_t, target_from_scene, 0.003, 2 * seed);
    const ScanFeatures source = see(room, eye_s, source_from_scene, 0.003, 2 * seed + 1);
    const GlobalAlignment result = alignGlobally(target, source, GlobalAlignmentParams{});
    // Exact planes at the target, 3 mm of noise on thousands of samples at the source.
    expectPose(result, target_from_scene * source_from_scene.inverse(), degToRad(0.2), 0.01, seed);
    EXPECT_EQ(result.observed_dof, 6);
    EXPECT_GE(result.corner_matches.size(), 3U);
    for (const CornerMatch& m : result.corner_matches) {
      const Eigen::Vector3d moved =
          result.target_from_source *
          source.primitives_in_body.corners[static_cast<std::size_t>(m.source_corner)].position;
      const Eigen::Vector3d& fixed =
          target.primitives_in_body.corners[static_cast<std::size_t>(m.target_corner)].position;
      EXPECT_LT((moved - fixed).norm(), 0.03) << "seed " << seed;
    }
  }
}

TEST(AlignGlobally, ReportsTheHalfTurnOfAnEmptyRoomAsAmbiguous) {
  test::Random random(2);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const test::Rectangles room = test::roomSides({-2.5, -1.8, 0.0}, {2.5, 1.8, 2.4});
    const ScanFeatures target = see(room, {0.3, 0.2, 1.2}, random.pose(2.0), 0.002, seed);
    const ScanFeatures source = see(room, {-0.5, 0.1, 1.2}, random.pose(2.0), 0.002, seed + 100);
    const GlobalAlignment result = alignGlobally(target, source, GlobalAlignmentParams{});
    EXPECT_EQ(result.outcome, AlignmentOutcome::kAmbiguous) << describe(result.outcome);
    EXPECT_TRUE(result.target_from_source.matrix().isIdentity());
    EXPECT_GE(result.hypotheses.size(), 2U);
  }
}

TEST(AlignGlobally, ParallelPlanesAreInsufficient) {
  const test::Rectangles corridor = {{{0.0, 1.0, 1.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, 1.0}},
                                     {{0.0, -1.0, 1.0}, {0.0, 0.0, 1.0}, {2.0, 0.0, 0.0}}};
  const ScanFeatures scan = see(corridor, {0.0, 0.0, 1.0}, Eigen::Isometry3d::Identity(), 0.001, 1);
  ASSERT_EQ(scan.primitives_in_body.planes.size(), 2U);
  const GlobalAlignment result = alignGlobally(scan, scan, GlobalAlignmentParams{});
  EXPECT_EQ(result.outcome, AlignmentOutcome::kInsufficient);
  EXPECT_TRUE(result.target_from_source.matrix().isIdentity());
}

TEST(AlignGlobally, AnEdgeOfTwoWallsLeavesTheSlideAlongItUnseen) {
  // Floor and wall, both far wider than what the scan's end could tell: 8 m of them, seen from the
  // middle and 1 m further along.
  const test::Rectangles edge = {{{0.0, 1.0, 1.0}, {8.0, 0.0, 0.0}, {0.0, 0.0, 1.0}},
                                 {{0.0, 0.0, 0.0}, {8.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
  const auto view = [&](double x, std::uint64_t seed) {
    test::Rectangles part = edge;
    for (test::Rectangle& r : part) {
      r.half_u.x() = 2.0;
      r.center.x() = x;
    }
    return see(part, {x, -0.5, 1.0}, Eigen::Isometry3d::Identity(), 0.001, seed);
  };
  const GlobalAlignment result = alignGlobally(view(0.0, 1), view(1.0, 2), GlobalAlignmentParams{});
  EXPECT_EQ(result.outcome, AlignmentOutcome::kInsufficient) << describe(result.outcome);
  EXPECT_LT(result.observed_dof, 6);
}

TEST(AlignGlobally, ScansOfDifferentRoomsAreNotForcedTogether) {
  int aligned = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const test::Rectangles small = test::roomSides({-1.0, -0.8, 0.0}, {1.0, 0.8, 2.0});
    const ScanFeatures target =
        see(test::furnishedRoom(seed), {0.0, 0.0, 1.3}, Eigen::Isometry3d::Identity(), 0.002, seed);
    const ScanFeatures source =
        see(small, {0.0, 0.0, 1.3}, Eigen::Isometry3d::Identity(), 0.002, seed);
    const GlobalAlignment result = alignGlobally(target, source, GlobalAlignmentParams{});
    if (result.outcome == AlignmentOutcome::kAligned) ++aligned;
  }
  EXPECT_EQ(aligned, 0);
}

TEST(AlignGlobally, EmptyScansAreInsufficient) {
  const ScanFeatures room =
      see(test::furnishedRoom(1), {0.0, 0.0, 1.3}, Eigen::Isometry3d::Identity(), 0.0, 1);
  for (const GlobalAlignment& result :
       {alignGlobally(ScanFeatures{}, room, GlobalAlignmentParams{}),
        alignGlobally(room, ScanFeatures{}, GlobalAlignmentParams{}),
        alignGlobally(ScanFeatures{}, ScanFeatures{}, GlobalAlignmentParams{})}) {
    EXPECT_EQ(result.outcome, AlignmentOutcome::kInsufficient);
    EXPECT_EQ(result.observed_dof, 0);
    EXPECT_TRUE(result.hypotheses.empty());
  }
}

TEST(AlignGlobally, RepeatsItselfToTheLastBit) {
  test::Random random(3);
  const test::Rectangles room = test::furnishedRoom(5);
  const ScanFeatures target = see(room, {0.3, 0.2, 1.2}, random.pose(2.0), 0.003, 1);
  const ScanFeatures source = see(room, {-0.4, 0.1, 1.4}, random.pose(2.0), 0.003, 2);
  const GlobalAlignment first = alignGlobally(target, source, GlobalAlignmentParams{});
  for (int k = 0; k < 10; ++k) {
    const GlobalAlignment again = alignGlobally(target, source, GlobalAlignmentParams{});
    EXPECT_EQ(again.target_from_source.matrix(), first.target_from_source.matrix());
    EXPECT_EQ(again.covariance, first.covariance);
    EXPECT_EQ(again.clarity, first.clarity);
  }
}

TEST(AlignGlobally, RejectsWhatTheCallerGotWrong) {
  const ScanFeatures room =
      see(test::furnishedRoom(1), {0.0, 0.0, 1.3}, Eigen::Isometry3d::Identity(), 0.0, 1);
  ScanFeatures unlabelled = room;
  unlabelled.primitives_in_body.labels.clear();
  EXPECT_THROW(alignGlobally(room, unlabelled, GlobalAlignmentParams{}), std::invalid_argument);
  ScanFeatures unspaced = room;
  unspaced.cloud_in_body.spacing = 0.0;
  EXPECT_THROW(alignGlobally(unspaced, room, GlobalAlignmentParams{}), std::invalid_argument);
  GlobalAlignmentParams params;
  params.min_clarity = 2.0;
  EXPECT_THROW(alignGlobally(room, room, params), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
