// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detection/detect_opps.h"

#include "opp/detection/pair_feature.h"
#include "opp/geometry/constants.h"

#include "support/degenerate_clouds.h"
#include "support/random.h"
#include "support/synthetic_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace opp {
namespace {

test::SyntheticScene idealRoom() {
  return test::sampleScene(test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5}), {0.3, 0.2, 1.2},
                           Eigen::Isometry3d::Identity(), {});
}

double distanceToTruth(const test::SyntheticScene& scene, const Plane& plane) {
  double least = 1e9;
  for (const Plane& truth : scene.planes) {
    least = std::min(least, (truth.coefficients() - plane.coefficients()).norm());
  }
  return least;
}

TEST(PairFeature, IsEquation2) {
  const PairFeature feature =
      pairFeature({1.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 2.0F}, {1.0F, 0.0F, 0.0F});
  EXPECT_FLOAT_EQ(feature.normals, 0.0F);
  EXPECT_FLOAT_EQ(feature.reference, -2.0F);
  EXPECT_FLOAT_EQ(feature.partner, 1.0F);
  EXPECT_FLOAT_EQ(feature.squared_distance, 5.0F);
}

TEST(DirectionAngle, IsTheAngleOfTheDirection) {
  test::Random random(2);
  // 1.2·10⁻⁵ of the series and the rounding of single precision.
  const double tolerance = 1.5e-5;
  for (int k = 0; k < 1000; ++k) {
    const double angle = random.uniform(-kPi, kPi), length = random.uniform(0.1, 10.0);
    const Eigen::Vector2f direction =
        (length * Eigen::Vector2d(std::cos(angle), std::sin(angle))).cast<float>();
    EXPECT_NEAR(static_cast<double>(directionAngle(direction)), angle, tolerance);
  }
  EXPECT_NEAR(static_cast<double>(directionAngle({0.0F, 1.0F})), 0.5 * kPi, tolerance);
  EXPECT_NEAR(static_cast<double>(directionAngle({-1.0F, 0.0F})), kPi, tolerance);
  EXPECT_NEAR(static_cast<double>(directionAngle({1.0F, 0.0F})), 0.0, tolerance);
}

TEST(DetectOpps, HypothesesOfAnIdealRoomAreItsWalls) {
  const test::SyntheticScene scene = idealRoom();
  const VotingParams params;
  const OppHypotheses found = detectOpps(scene.cloud, SensorModel{}, params);
  // All reference points lie on a wall; most see another one within the neighbourhood.
  ASSERT_GT(found.pairs.size(), static_cast<std::size_t>(params.round_size));
  for (const PlaneHypothesis& hypothesis : found.planes) {
    // float32 points within 3 m.
    EXPECT_LT(distanceToTruth(scene, hypothesis.plane), 1e-5) << hypothesis.plane;
    EXPECT_NEAR(hypothesis.plane.signedDistance(hypothesis.anchor), 0.0, 1e-9);
  }
  for (const OrthogonalPair& pair : found.pairs) {
    const Plane& reference = found.planes[static_cast<std::size_t>(pair.reference)].plane;
    const Plane& partner = found.planes[static_cast<std::size_t>(pair.partner)].plane;
    EXPECT_NEAR(angleBetween(reference, partner), kPi / 2.0, 1e-5);
  }
}

TEST(DetectOpps, SingleWallGivesLonePlanes) {
  const test::Rectangles wall = {{{0.0, 0.0, 0.0}, {1.5, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
  const test::SyntheticScene scene =
      test::sampleScene(wall, {0.0, 0.0, 2.0}, Eigen::Isometry3d::Identity(), {});
  const VotingParams params;
  const OppHypotheses found = detectOpps(scene.cloud, SensorModel{}, params);
  // The first round explains the whole wall.
  EXPECT_EQ(found.planes.size(), static_cast<std::size_t>(params.round_size));
  EXPECT_TRUE(found.pairs.empty());
}

TEST(DetectOpps, FindsThePlanesOfFurnishedRooms) {
  int planes = 0, missed = 0;
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    test::SyntheticOptions options;
    options.sigma = 0.003;
    options.normal_sigma = degToRad(4.0);
    options.min_plane_samples = 40;
    options.seed = seed;
    const test::SyntheticScene scene = test::sampleScene(test::furnishedRoom(seed), {0.0, 0.0, 1.5},
                                                         Eigen::Isometry3d::Identity(), options);
    const OppHypotheses found = detectOpps(scene.cloud, SensorModel{}, VotingParams{});
    for (const Plane& truth : scene.planes) {
      // 40 samples 5 cm apart fix a normal to σ/√40 over 9 cm, 0.3°, ten times that is allowed; an
      // anchor may be off by three samples' noise.
      const bool hit = std::any_of(
          found.planes.begin(), found.planes.end(), [&](const PlaneHypothesis& hypothesis) {
            return angleBetween(hypothesis.plane, truth) < degToRad(3.0) &&
                   std::abs(truth.signedDistance(hypothesis.anchor)) < 0.01;
          });
      ++planes;
      missed += hit ? 0 : 1;
    }
  }
  ASSERT_GT(planes, 250);
  // Small ones among others within the noise, 1 in 200.
  EXPECT_LE(missed, planes / 100);
}

TEST(DetectOpps, IsUnbiasedUnderNoise) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  double count = 0.0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::SyntheticOptions options;
    options.sigma = 0.005;
    options.normal_sigma = degToRad(4.0);
    options.seed = seed;
    const test::SyntheticScene scene =
        test::sampleScene(test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5}), {0.3, 0.2, 1.2},
                          Eigen::Isometry3d::Identity(), options);
    for (const auto& hypothesis : detectOpps(scene.cloud, SensorModel{}, VotingParams{}).planes) {
      for (const Plane& truth : scene.planes) {
        if (truth.normal().dot(hypothesis.plane.normal()) < 0.99) continue;
        sum += hypothesis.plane.coefficients() - truth.coefficients();
        count += 1.0;
      }
    }
  }
  ASSERT_GT(count, 5000.0);
  // One hypothesis errs by about σ/√30 over 0.5 m: 0.2° and 1 mm at its anchor, several mm at the
  // origin. Some 10⁴ of them, of which a few hundred are independent: a tenth of that remains.
  EXPECT_LT((sum / count).head<3>().norm(), degToRad(0.05));
  EXPECT_LT(std::abs(sum[3] / count), 0.001);
}

TEST(DetectOpps, SignsOfNormalsDoNotMatter) {
  test::SyntheticOptions options;
  options.normal_sigma = degToRad(3.0);
  options.seed = 7;
  const auto sides = test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5});
  test::SyntheticScene scene =
      test::sampleScene(sides, {0.3, 0.2, 1.2}, Eigen::Isometry3d::Identity(), options);
  const OppHypotheses expected = detectOpps(scene.cloud, SensorModel{}, VotingParams{});
  test::Random random(8);
  for (auto& normal : scene.cloud.normals) {
    if (random.integer(0, 1) == 1) normal = -normal;
  }
  const OppHypotheses found = detectOpps(scene.cloud, SensorModel{}, VotingParams{});
  // A flipped reference normal gives other tangents and so other bin edges: votes at the border of
  // a peak may differ, planes may not.
  EXPECT_NEAR(static_cast<double>(found.planes.size()), static_cast<double>(expected.planes.size()),
              0.02 * static_cast<double>(expected.planes.size()));
  for (const auto& hypothesis : found.planes) {
    EXPECT_LT(distanceToTruth(scene, hypothesis.plane), 1e-4);
  }
}

TEST(DetectOpps, IsTheSameForEveryNumberOfThreads) {
  test::SyntheticOptions options;
  options.sigma = 0.004;
  options.normal_sigma = 0.05;
  options.outlier_ratio = 0.2;
  const test::SyntheticScene scene = test::sampleScene(test::furnishedRoom(1), {0.0, 0.0, 1.5},
                                                       Eigen::Isometry3d::Identity(), options);
  const OppHypotheses one = detectOpps(scene.cloud, SensorModel{}, VotingParams{}, 1);
  for (const int threads : {2, 5}) {
    const OppHypotheses many = detectOpps(scene.cloud, SensorModel{}, VotingParams{}, threads);
    ASSERT_EQ(many.planes.size(), one.planes.size());
    ASSERT_EQ(many.pairs.size(), one.pairs.size());
    for (std::size_t i = 0; i < one.planes.size(); ++i) {
      EXPECT_EQ(many.planes[i].plane.coefficients(), one.planes[i].plane.coefficients());
      EXPECT_EQ(many.planes[i].votes, one.planes[i].votes);
    }
    for (std::size_t i = 0; i < one.pairs.size(); ++i) {
      EXPECT_EQ(many.pairs[i].reference, one.pairs[i].reference);
      EXPECT_EQ(many.pairs[i].partner, one.pairs[i].partner);
    }
  }
}

TEST(DetectOpps, ClutterGivesAlmostNoHypotheses) {
  std::size_t planes = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    planes +=
        detectOpps(test::randomCloud(seed, 2000), SensorModel{}, VotingParams{}).planes.size();
  }
  // 50 × 600 reference points with 10⁻³ expected false alarms each, before the planes are fitted.
  EXPECT_LE(planes, 30U);
}

TEST(DetectOpps, DegenerateCloudsGiveFiniteHypotheses) {
  for (const auto& [name, cloud] : test::degenerateClouds()) {
    SCOPED_TRACE(name);
    const OppHypotheses found = detectOpps(cloud, SensorModel{}, VotingParams{});
    for (const auto& hypothesis : found.planes) {
      EXPECT_TRUE(hypothesis.plane.coefficients().allFinite());
      EXPECT_TRUE(hypothesis.anchor.allFinite());
    }
  }
}

TEST(DetectOpps, RejectsParametersOutOfRange) {
  VotingParams params;
  params.partners = 0;
  EXPECT_THROW(detectOpps(idealRoom().cloud, SensorModel{}, params), std::invalid_argument);
}

}  // namespace
}  // namespace opp
