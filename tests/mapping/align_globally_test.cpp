// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/align_globally.h"

#include "opp/geometry/constants.h"

#include "support/random.h"
#include "support/synthetic_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

/// The noise of `see`'s scans.
SensorModel sensor() {
  SensorModel result;
  result.noise_correlation = 0.0;
  return result;
}

GlobalAlignment align(const AlignmentInput& target, const AlignmentInput& source) {
  return alignGlobally(target, source, sensor(), GlobalAlignmentParams{});
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
    const GlobalAlignment result = align(target, source);
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
    const GlobalAlignment result = align(target, source);
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
  const GlobalAlignment result = align(scan, scan);
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
  const GlobalAlignment result = align(view(0.0, 1), view(1.0, 2));
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
    const GlobalAlignment result = align(target, source);
    if (result.outcome == AlignmentOutcome::kAligned) ++aligned;
  }
  EXPECT_EQ(aligned, 0);
}

/// Floor and two walls of a corner at the origin, seen from (2, 1.5, 1.2); each `reach` wide.
test::Rectangles bareCorner(const Eigen::Vector3d& reach) {
  const Eigen::Vector3d x(0.5 * reach.x(), 0, 0), y(0, 0.5 * reach.y(), 0),
      z(0, 0, 0.5 * reach.z());
  return {{x + y, x, y}, {y + z, y, z}, {x + z, z, x}};
}

TEST(AlignGlobally, ABareCornerConfirmsNothing) {
  // Two corners of two rooms; all that a scan can see of them is alike.
  const Eigen::Isometry3d same = Eigen::Isometry3d::Identity();
  const ScanFeatures target = see(bareCorner({4.0, 2.5, 1.2}), {2.0, 1.5, 0.9}, same, 0.001, 1);
  const ScanFeatures source = see(bareCorner({3.0, 1.8, 0.85}), {1.5, 1.4, 0.7}, same, 0.001, 2);
  const GlobalAlignment result = align(target, source);
  EXPECT_EQ(result.outcome, AlignmentOutcome::kUnconfirmed)
      << describe(result.outcome) << ", clarity " << result.clarity;
  EXPECT_LT(result.confirmation, 0.01);
  EXPECT_TRUE(result.target_from_source.matrix().isIdentity());
  // Who knows the pose to begin with gets it refined.
  const GlobalAlignment near =
      alignNear(target, source, retract(same, Vector6d::Constant(0.02)), sensor(), {});
  expectPose(near, same, degToRad(0.2), 0.005, 0);
}

/// A corner of three equal sides, each with a cube of one of these widths on its middle: turns lay
/// the sides on each other.
test::Rectangles cornerWithCubes(const std::vector<double>& widths) {
  test::Rectangles scene = bareCorner({2.5, 2.5, 2.5});
  for (std::size_t k = 0; k < widths.size(); ++k) {
    Eigen::Vector3d center = Eigen::Vector3d::Constant(1.2);
    center[static_cast<Eigen::Index>(k)] = 0.5 * widths[k];
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * widths[k]);
    for (const test::Rectangle& side : test::boxSides(center - half, center + half)) {
      scene.push_back(side);
    }
  }
  return scene;
}

GlobalAlignment alignCornerWithCubes(const std::vector<double>& widths) {
  const test::Rectangles scene = cornerWithCubes(widths);
  const Eigen::Isometry3d same = Eigen::Isometry3d::Identity();
  return align(see(scene, {2.4, 2.5, 2.6}, same, 0.001, 1),
               see(scene, {2.6, 2.4, 2.5}, same, 0.001, 2));
}

TEST(AlignGlobally, APoseThatNothingConfirmsIsAWeakRival) {
  // The turns lose the only cube, which is all that tells them apart from the right pose.
  const GlobalAlignment one = alignCornerWithCubes({0.35});
  EXPECT_LT(one.clarity, GlobalAlignmentParams().min_clarity);
  expectPose(one, Eigen::Isometry3d::Identity(), degToRad(0.2), 0.005, 0);
  // As clear, but here a turn lays cubes on cubes that are hardly smaller.
  const GlobalAlignment three = alignCornerWithCubes({0.55, 0.5, 0.5});
  EXPECT_GE(three.clarity, one.clarity);
  EXPECT_EQ(three.outcome, AlignmentOutcome::kAmbiguous) << describe(three.outcome);
}

TEST(AlignGlobally, ManagesWithoutSidesAndViewpoints) {
  test::Random random(4);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const test::Rectangles room = test::furnishedRoom(seed);
    const Eigen::Isometry3d target_from_scene = random.pose(3.0),
                            source_from_scene = random.pose(3.0);
    const ScanFeatures target = see(room, {0.3, 0.2, 1.3}, target_from_scene, 0.002, 2 * seed);
    ScanFeatures source = see(room, {-0.4, -0.3, 1.2}, source_from_scene, 0.002, 2 * seed + 1);
    for (Eigen::Vector3f& n : source.cloud_in_body.normals) {
      if (random.uniform(-1.0, 1.0) < 0.0) n = -n;
    }
    for (PlanePrimitive& p : source.primitives_in_body.planes) {
      if (random.uniform(-1.0, 1.0) < 0.0) p.plane = p.plane.flipped();
    }
    const GlobalAlignment result = align(target, {source, {}, false});
    expectPose(result, target_from_scene * source_from_scene.inverse(), degToRad(0.3), 0.01, seed);
  }
}

/// Two scans in the frame of the first.
ScanFeatures merged(const ScanFeatures& a, const ScanFeatures& b,
                    const Eigen::Isometry3d& a_from_b) {
  ScanFeatures both = a;
  const int offset = static_cast<int>(a.primitives_in_body.planes.size());
  OrientedCloud& cloud = both.cloud_in_body;
  for (std::size_t i = 0; i < b.cloud_in_body.size(); ++i) {
    cloud.points.push_back(a_from_b.cast<float>() * b.cloud_in_body.points[i]);
    cloud.normals.push_back(a_from_b.linear().cast<float>() * b.cloud_in_body.normals[i]);
    cloud.sigmas.push_back(b.cloud_in_body.sigmas[i]);
    cloud.weights.push_back(b.cloud_in_body.weights[i]);
    const int label = b.primitives_in_body.labels[i];
    both.primitives_in_body.labels.push_back(label < 0 ? -1 : label + offset);
  }
  for (PlanePrimitive plane : b.primitives_in_body.planes) {
    plane.plane = transformed(a_from_b, plane.plane);
    plane.moments = transformed(a_from_b, plane.moments);
    both.primitives_in_body.planes.push_back(plane);
  }
  return both;
}

TEST(AlignGlobally, TakesMergedScansAsTargetAndAsSource) {
  test::Random random(5);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const test::Rectangles room = test::furnishedRoom(seed);
    const Eigen::Isometry3d a_from_scene = random.pose(3.0), b_from_scene = random.pose(3.0),
                            scan_from_scene = random.pose(3.0);
    const ScanFeatures a = see(room, {0.7, 0.2, 1.3}, a_from_scene, 0.002, 3 * seed);
    const ScanFeatures b = see(room, {-0.7, -0.3, 1.2}, b_from_scene, 0.002, 3 * seed + 1);
    const ScanFeatures scan = see(room, {0.1, 0.5, 1.1}, scan_from_scene, 0.002, 3 * seed + 2);
    const Eigen::Isometry3d a_from_b = a_from_scene * b_from_scene.inverse();
    const ScanFeatures both = merged(a, b, a_from_b);
    const AlignmentInput map(
        both, {{&a.cloud_in_body, Eigen::Isometry3d::Identity()}, {&b.cloud_in_body, a_from_b}},
        true);
    const Eigen::Isometry3d truth = a_from_scene * scan_from_scene.inverse();
    const GlobalAlignment found = align(map, scan);
    expectPose(found, truth, degToRad(0.2), 0.01, seed);
    EXPECT_LT(found.hypotheses.front().conflict, 0.02) << seed;
    expectPose(align(scan, map), truth.inverse(), degToRad(0.2), 0.01, seed);
  }
}

TEST(AlignGlobally, ItsCovarianceCoversItsError) {
  test::Random random(6);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const test::Rectangles room = test::furnishedRoom(seed);
    const Eigen::Isometry3d target_from_scene = random.pose(3.0);
    const ScanFeatures target = see(room, {0.4, 0.2, 1.3}, target_from_scene, 0.005, 2 * seed);
    const ScanFeatures source =
        see(room, {-0.3, 0.1, 1.2}, Eigen::Isometry3d::Identity(), 0.005, 2 * seed + 1);
    const GlobalAlignment result = align(target, source);
    ASSERT_EQ(result.outcome, AlignmentOutcome::kAligned) << seed;
    const Vector6d error = difference(target_from_scene, result.target_from_source);
    // 0.9999 quantile of chi-square with 6 degrees of freedom.
    EXPECT_LT(error.dot(result.covariance.inverse() * error), 27.9) << seed;
    EXPECT_LT(std::sqrt(result.covariance.diagonal().tail<3>().maxCoeff()), 0.005) << seed;
  }
}

/// Bends what a scan shows: a smooth random error of its ranges with the deviation 0.002 r², which
/// changes by as much within 0.1 rad.
void distort(test::Random& random, ScanFeatures& scan) {
  constexpr int kWaves = 40;
  std::vector<std::pair<Eigen::Vector3d, double>> waves;
  for (int i = 0; i < kWaves; ++i)
    waves.emplace_back(10.0 * random.unitVector(), random.uniform(0.0, 2.0 * kPi));
  for (Eigen::Vector3f& point : scan.cloud_in_body.points) {
    const Eigen::Vector3d ray = (point - scan.cloud_in_body.viewpoint).cast<double>();
    const double range = ray.norm();
    double error = 0.0;
    for (const auto& [wave, phase] : waves)
      error += std::sqrt(2.0 / kWaves) * std::cos(wave.dot(ray) / range + phase);
    point += (0.002 * range * error * ray).cast<float>();
  }
}

TEST(AlignGlobally, ItsCovarianceKnowsThatDistortionDoesNotAverageOut) {
  test::Random random(8);
  std::vector<double> with, without;  // squared error over covariance
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const test::Rectangles room = test::furnishedRoom(seed);
    const Eigen::Isometry3d target_from_scene = random.pose(3.0);
    ScanFeatures target = see(room, {0.4, 0.2, 1.3}, target_from_scene, 0.003, 2 * seed);
    ScanFeatures source =
        see(room, {-0.3, 0.1, 1.2}, Eigen::Isometry3d::Identity(), 0.003, 2 * seed + 1);
    distort(random, target);
    distort(random, source);
    for (const bool known : {false, true}) {
      SensorModel model = sensor();
      if (!known) model.distortion_quadratic = 0.0;
      const GlobalAlignment result = alignGlobally(target, source, model, GlobalAlignmentParams{});
      ASSERT_EQ(result.outcome, AlignmentOutcome::kAligned) << seed;
      const Vector6d error = difference(target_from_scene, result.target_from_source);
      (known ? with : without).push_back(error.dot(result.covariance.inverse() * error));
    }
  }
  std::sort(with.begin(), with.end());
  std::sort(without.begin(), without.end());
  // The median of chi-square with 6 degrees of freedom is 5.3, its 0.9999 quantile 27.9.
  EXPECT_GT(without[without.size() / 2], 15.0);
  EXPECT_LT(with[with.size() / 2], 8.0);
  EXPECT_GT(with[with.size() / 2], 1.0);
  EXPECT_LT(with.back(), 27.9);
}

TEST(JudgePose, TellsARightPoseFromAWrongOneAndChangesNeither) {
  test::Random random(7);
  const test::Rectangles room = test::furnishedRoom(3);
  const Eigen::Isometry3d truth = random.pose(3.0);
  const ScanFeatures target = see(room, {0.4, 0.2, 1.3}, truth, 0.002, 1);
  const ScanFeatures source = see(room, {-0.3, 0.1, 1.2}, Eigen::Isometry3d::Identity(), 0.002, 2);
  const GlobalAlignment right = judgePose(target, source, truth, sensor(), {});
  EXPECT_EQ(right.outcome, AlignmentOutcome::kAligned);
  EXPECT_EQ(right.target_from_source.matrix(), truth.matrix());
  for (int k = 0; k < 50; ++k) {
    const GlobalAlignment wrong = judgePose(target, source, random.pose(2.0) * truth, sensor(), {});
    EXPECT_NE(wrong.outcome, AlignmentOutcome::kAligned) << k;
    EXPECT_TRUE(wrong.target_from_source.matrix().isIdentity());
  }
}

TEST(AlignGlobally, EmptyScansAreInsufficient) {
  const ScanFeatures room =
      see(test::furnishedRoom(1), {0.0, 0.0, 1.3}, Eigen::Isometry3d::Identity(), 0.0, 1);
  for (const GlobalAlignment& result : {align(ScanFeatures{}, room), align(room, ScanFeatures{}),
                                        align(ScanFeatures{}, ScanFeatures{})}) {
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
  const GlobalAlignment first = align(target, source);
  for (int k = 0; k < 10; ++k) {
    const GlobalAlignment again = align(target, source);
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
  EXPECT_THROW(align(room, unlabelled), std::invalid_argument);
  ScanFeatures unspaced = room;
  unspaced.cloud_in_body.spacing = 0.0;
  EXPECT_THROW(align(unspaced, room), std::invalid_argument);
  GlobalAlignmentParams params;
  params.min_clarity = 2.0;
  EXPECT_THROW(alignGlobally(room, room, sensor(), params), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
