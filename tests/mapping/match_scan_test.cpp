// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/match_scan.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/registration/plane_samples.h"

#include "registration/observability.h"
#include "support/random.h"
#include "support/synthetic_features.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp::mapping {
namespace {

constexpr double kSpacing = 0.09;

struct ScanAndMap {
  ScanFeatures scan;
  LocalMap map{kSpacing, SensorModel{}, RegistrationParams{}};
  Eigen::Isometry3d map_from_body = Eigen::Isometry3d::Identity();
};

/// A room as seen from the origin (the map, which is the scene's frame) and again from a body a
/// step away. Landmarks are the room's planes if `with_landmarks`.
ScanAndMap seeTwice(const test::Rectangles& room, std::uint64_t seed, bool with_landmarks,
                    const test::SyntheticOptions& options) {
  test::Random random(seed);
  const Eigen::Vector3d eye(0.0, 0.0, 1.3);
  ScanAndMap both;
  both.map_from_body = random.motion(0.3, 0.3);
  both.map_from_body.translation() += eye;
  test::SyntheticOptions second = options;
  second.seed = 2 * seed + 1;
  both.scan = test::trueFeatures(test::sampleScene(room, both.map_from_body.translation(),
                                                   both.map_from_body.inverse(), second));
  second.seed = 2 * seed;
  const ScanFeatures target =
      test::trueFeatures(test::sampleScene(room, eye, Eigen::Isometry3d::Identity(), second));
  std::vector<int> landmarks(target.primitives_in_body.planes.size(), -1);
  if (with_landmarks) std::iota(landmarks.begin(), landmarks.end(), 0);
  both.map.insert(target, Eigen::Isometry3d::Identity(), landmarks);
  std::vector<Plane> planes;
  for (const PlanePrimitive& p : target.primitives_in_body.planes) planes.push_back(p.plane);
  if (with_landmarks) both.map.setLandmarks(planes);
  return both;
}

test::SyntheticOptions options(double sigma) {
  test::SyntheticOptions result;
  result.spacing = kSpacing;
  result.sigma = sigma;
  return result;
}

/// True pose, moved by up to 3° and 5 cm, with an information that hardly pulls.
PosePrior perturbed(const Eigen::Isometry3d& pose, test::Random& random) {
  PosePrior prior;
  Vector6d omega_v;
  omega_v << degToRad(random.uniform(0.0, 3.0)) * random.unitVector(),
      random.uniform(0.0, 0.05) * random.unitVector();
  prior.map_from_body = retract(pose, omega_v);
  prior.information = 1e-6 * Matrix6d::Identity();
  return prior;
}

TEST(MatchScan, RecoversThePoseInExactRoomsThroughPlaneLandmarks) {
  test::Random random(1);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const ScanAndMap both = seeTwice(test::furnishedRoom(seed), seed, true, options(0.0));
    const PosePrior prior = perturbed(both.map_from_body, random);
    const MatchResult result = matchScan(both.scan, both.map, prior, RegistrationParams{});
    const Vector6d error = difference(both.map_from_body, result.map_from_body);
    // Exact landmarks; what is left comes from points on surfels that average across an edge.
    EXPECT_LT(error.head<3>().norm(), 1e-3) << "seed " << seed;
    EXPECT_LT(error.tail<3>().norm(), 1e-3) << "seed " << seed;
    EXPECT_TRUE(result.converged);
    EXPECT_GT(result.overlap, 0.7);
    EXPECT_GE(result.planes.size(), 3U);
    for (const PlaneAssociation& p : result.planes) {
      const Plane expected = transformed(
          both.map_from_body,
          both.scan.primitives_in_body.planes[static_cast<std::size_t>(p.scan_plane)].plane);
      const Plane& found = both.map.landmarkPlanes()[static_cast<std::size_t>(p.landmark)];
      EXPECT_TRUE(found.coefficients().isApprox(expected.coefficients(), 1e-6));
    }
  }
}

TEST(MatchScan, RecoversThePoseOfNoisyScansFromPointsAlone) {
  test::Random random(2);
  const double sigma = 0.005;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const ScanAndMap both = seeTwice(test::furnishedRoom(seed), seed, false, options(sigma));
    const PosePrior prior = perturbed(both.map_from_body, random);
    const MatchResult result = matchScan(both.scan, both.map, prior, RegistrationParams{});
    const Vector6d error = difference(both.map_from_body, result.map_from_body);
    // 2500 points, at least a tenth of them facing each axis: 4·σ·√2/√250 = 1.8 mm in each of
    // three directions, rounded up; the lever arm of the rotation is about 1 m.
    EXPECT_LT(error.head<3>().norm(), 0.003) << "seed " << seed;
    EXPECT_LT(error.tail<3>().norm(), 0.003) << "seed " << seed;
  }
}

TEST(MatchScan, IsNotMisledByThirtyPercentOfMovedPoints) {
  test::Random random(3);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    ScanAndMap both = seeTwice(test::furnishedRoom(seed), seed, false, options(0.002));
    OrientedCloud& cloud = both.scan.cloud_in_body;
    const Eigen::Isometry3f moved = random.motion(0.2, 0.3).cast<float>();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (random.uniform(0.0, 1.0) > 0.3) continue;
      cloud.points[i] = moved * cloud.points[i];
      cloud.normals[i] = moved.linear() * cloud.normals[i];
      both.scan.primitives_in_body.labels[i] = -1;
    }
    const PosePrior prior = perturbed(both.map_from_body, random);
    const MatchResult result = matchScan(both.scan, both.map, prior, RegistrationParams{});
    const Vector6d error = difference(both.map_from_body, result.map_from_body);
    // 3·σ/√250 = 0.4 mm of noise and what the Cauchy tails of 30 % of outliers leave.
    EXPECT_LT(error.head<3>().norm(), 0.004) << "seed " << seed;
    EXPECT_LT(error.tail<3>().norm(), 0.005) << "seed " << seed;
  }
}

TEST(MatchScan, ASingleWallFixesThreeDirectionsAndThePriorTheRest) {
  const test::Rectangles wall = {{{2.0, 0.0, 1.3}, {0.0, 0.0, 1.0}, {0.0, 1.5, 0.0}}};
  // Seen from x < 2, that is from the side of half_u × half_v = −x.
  const ScanAndMap both = seeTwice(wall, 7, true, options(0.0));
  ASSERT_GT(both.scan.cloud_in_body.size(), 100U);
  PosePrior prior;
  Vector6d omega_v;
  omega_v << 0.0, 0.01, 0.0, 0.03, 0.02, 0.01;
  prior.map_from_body = retract(both.map_from_body, omega_v);
  prior.information = Matrix6d::Identity();
  const MatchResult result = matchScan(both.scan, both.map, prior, RegistrationParams{});
  const Vector6d error = difference(both.map_from_body, result.map_from_body);
  // Information of the prior is 1e-6 of the wall's: its pull is below 1e-3.
  EXPECT_NEAR(error[1], 0.0, 1e-3);
  EXPECT_NEAR(error[2], 0.0, 1e-3);
  EXPECT_NEAR(error[0], 0.0, 1e-3);  // the prior is right about the turn about the wall's normal
  EXPECT_NEAR(error[4], 0.02, 1e-3);
  EXPECT_NEAR(error[5], 0.01, 1e-3);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(result.information);
  EXPECT_LT(eigen.eigenvalues()[2], 1e-6 * eigen.eigenvalues()[3]);
}

/// Rims of a window of 1 m × 1 m in the wall of the tests above, each side in `per_side` pieces,
/// with noise across them.
Rims windowRims(const Eigen::Isometry3d& body_from_map, int per_side, double sigma,
                test::Random& random) {
  Rims rims;
  for (const bool upright : {true, false}) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d across = side * Eigen::Vector3d::Unit(upright ? 1 : 2);
      const Eigen::Vector3d along = Eigen::Vector3d::Unit(upright ? 2 : 1);
      for (int k = 0; k < per_side; ++k) {
        const Eigen::Vector3d point = Eigen::Vector3d(2.0, 0.0, 1.3) +
                                      (0.5 + random.normal(sigma)) * across +
                                      ((k + 0.5) / per_side - 0.5) * along;
        rims.points.push_back((body_from_map * point).cast<float>());
        rims.normals.push_back((body_from_map.linear() * -across).cast<float>());
        rims.sigmas.push_back(static_cast<float>(sigma));
      }
    }
  }
  return rims;
}

TEST(MatchScan, RimsFixWhatABareWallLeavesOpen) {
  const test::Rectangles wall = {{{2.0, 0.0, 1.3}, {0.0, 0.0, 1.0}, {0.0, 1.5, 0.0}}};
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Random random(seed);
    ScanAndMap both = seeTwice(wall, seed, true, options(0.002));
    ScanFeatures rims_alone;
    rims_alone.rims_in_body = windowRims(Eigen::Isometry3d::Identity(), 20, 0.01, random);
    both.map.insert(rims_alone, Eigen::Isometry3d::Identity(), {});
    both.scan.rims_in_body = windowRims(both.map_from_body.inverse(), 20, 0.01, random);
    PosePrior prior;
    prior.map_from_body = both.map_from_body;
    prior.map_from_body.translation() += Eigen::Vector3d(0.0, 0.06, -0.05);
    prior.information.diagonal() << Eigen::Vector3d::Constant(std::pow(degToRad(3.0), -2)),
        Eigen::Vector3d::Constant(100.0);
    const MatchResult result = matchScan(both.scan, both.map, prior, RegistrationParams{});
    // At the wall, where a turn about its normal and a shift tell apart.
    const Eigen::Vector3d window(2.0, 0.0, 1.3);
    const Eigen::Vector3d error =
        result.map_from_body * (both.map_from_body.inverse() * window) - window;
    EXPECT_LT(std::abs(error.y()), 0.01) << "seed " << seed;
    EXPECT_LT(std::abs(error.z()), 0.01) << "seed " << seed;
    // 10 independent ones of 1 cm at best, a quarter of them on each side.
    const double sigma = std::sqrt(largestVariance(result.covariance.bottomRightCorner<3, 3>()));
    EXPECT_GT(sigma, 0.01 / std::sqrt(5.0)) << "seed " << seed;
    EXPECT_LT(sigma, 0.03) << "seed " << seed;
    EXPECT_GT(result.overlap, 0.9) << "seed " << seed;
  }
}

TEST(MatchScan, RimsCountForLittleWhereSurfacesFixThePose) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Random random(seed);
    ScanAndMap both = seeTwice(test::furnishedRoom(seed), seed, true, options(0.002));
    const PosePrior prior = perturbed(both.map_from_body, random);
    const MatchResult without = matchScan(both.scan, both.map, prior, RegistrationParams{});
    ScanFeatures rims_alone;
    rims_alone.rims_in_body = windowRims(Eigen::Isometry3d::Identity(), 20, 0.01, random);
    both.map.insert(rims_alone, Eigen::Isometry3d::Identity(), {});
    // All rims moved by 2 cm: they are wrong together.
    both.scan.rims_in_body = windowRims(
        both.map_from_body.inverse() * Eigen::Translation3d(0.0, 0.02, 0.0), 20, 0.01, random);
    const MatchResult result = matchScan(both.scan, both.map, prior, RegistrationParams{});
    const Vector6d moved = difference(without.map_from_body, result.map_from_body);
    EXPECT_LT(moved.tail<3>().norm(), 0.001) << "seed " << seed;
  }
}

TEST(MatchScan, NoiseOnABareWallDoesNotPassForStructure) {
  const test::Rectangles wall = {{{2.0, 0.0, 1.3}, {0.0, 0.0, 1.0}, {0.0, 1.5, 0.0}}};
  test::SyntheticOptions noisy = options(0.003);
  noisy.normal_sigma = degToRad(2.0);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const bool with_landmarks : {true, false}) {
      const ScanAndMap both = seeTwice(wall, seed, with_landmarks, noisy);
      PosePrior prior;
      prior.map_from_body = both.map_from_body;
      prior.map_from_body.translation() += Eigen::Vector3d(0.01, 0.02, 0.01);
      // Known to 1 cm and 1°: noise must not take the prediction's place along the wall.
      prior.information.diagonal() << Eigen::Vector3d::Constant(std::pow(degToRad(1.0), -2)),
          Eigen::Vector3d::Constant(1e4);
      const MatchResult result = matchScan(both.scan, both.map, prior, RegistrationParams{});
      const Eigen::Vector3d error =
          result.map_from_body.translation() - both.map_from_body.translation();
      EXPECT_NEAR(error.x(), 0.0, 2e-3) << seed << with_landmarks;
      EXPECT_NEAR(error.y(), 0.02, 3e-3) << seed << with_landmarks;
      EXPECT_NEAR(error.z(), 0.01, 3e-3) << seed << with_landmarks;
      EXPECT_LT(result.covariance(3, 3), 1e-5) << seed << with_landmarks;
      EXPECT_GT(result.covariance(4, 4), 0.5e-4) << seed << with_landmarks;
      EXPECT_GT(result.covariance(5, 5), 0.5e-4) << seed << with_landmarks;
    }
  }
}

TEST(MatchScan, DoesNotSlideAlongAWallToSuitALandmarkThatIsSlightlyOff) {
  // A board on a wall; its landmark is turned by 0.2° and 2 mm off, which 0.6 m along the wall
  // mend.
  const test::Rectangles wall = {{{2.0, 0.0, 1.3}, {0.0, 0.0, 1.0}, {0.0, 1.5, 0.0}},
                                 {{1.9, 0.6, 1.3}, {0.0, 0.0, 0.8}, {0.0, 0.4, 0.0}}};
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    ScanAndMap both = seeTwice(wall, seed, true, options(0.001));
    std::vector<Plane> planes = both.map.landmarkPlanes();
    for (Plane& plane : planes) {
      const Eigen::Vector3d board(1.9, 0.6, 1.3);
      if (std::abs(plane.signedDistance(board)) > 0.01) continue;
      const Eigen::AngleAxisd turn(degToRad(0.2), Eigen::Vector3d::UnitZ());
      plane = Plane::fromPointNormal(board + 0.002 * plane.normal(), turn * plane.normal());
    }
    both.map.setLandmarks(planes);
    PosePrior prior;
    prior.map_from_body = both.map_from_body;
    prior.information.diagonal() << Eigen::Vector3d::Constant(std::pow(degToRad(1.0), -2)),
        Eigen::Vector3d::Constant(std::pow(0.2, -2));
    const MatchResult result = matchScan(both.scan, both.map, prior, RegistrationParams{});
    const Eigen::Vector3d error =
        result.map_from_body.translation() - both.map_from_body.translation();
    EXPECT_NEAR(error.x(), 0.0, 3e-3) << "seed " << seed;
    EXPECT_NEAR(error.y(), 0.0, 0.02) << "seed " << seed;
    EXPECT_NEAR(error.z(), 0.0, 0.02) << "seed " << seed;
    EXPECT_GT(std::sqrt(result.covariance(4, 4)), 0.1) << "seed " << seed;
  }
}

/// Whether a shelf 3.5 cm above one of the map is taken for that.
bool takesShelfForOneBelow(std::uint64_t seed, double distortion) {
  const auto seenWith = [&](double height, std::uint64_t noise) {
    test::Rectangles room = test::roomSides({-2.5, -2.0, 0.0}, {2.5, 2.0, 2.5});
    room.push_back({{2.1, 0.0, height}, {0.3, 0.0, 0.0}, {0.0, 0.5, 0.0}});
    test::SyntheticOptions noisy = options(0.003);
    noisy.seed = noise;
    return test::trueFeatures(
        test::sampleScene(room, {0.0, 0.0, 1.6}, Eigen::Isometry3d::Identity(), noisy));
  };
  const ScanFeatures target = seenWith(1.0, 2 * seed), scan = seenWith(1.035, 2 * seed + 1);
  SensorModel sensor;
  sensor.distortion_quadratic = distortion;
  LocalMap map(kSpacing, sensor, RegistrationParams{});
  std::vector<int> landmarks(target.primitives_in_body.planes.size());
  std::iota(landmarks.begin(), landmarks.end(), 0);
  map.insert(target, Eigen::Isometry3d::Identity(), landmarks);
  std::vector<Plane> planes;
  for (const PlanePrimitive& p : target.primitives_in_body.planes) planes.push_back(p.plane);
  map.setLandmarks(planes);
  PosePrior prior;
  prior.information = 1e4 * Matrix6d::Identity();
  const MatchResult result = matchScan(scan, map, prior, RegistrationParams{});
  EXPECT_GE(result.planes.size(), 5U) << "the sides of the room that are seen";
  return std::any_of(result.planes.begin(), result.planes.end(), [&](const PlaneAssociation& a) {
    const auto plane = static_cast<std::size_t>(a.scan_plane);
    const Plane& seen = scan.primitives_in_body.planes[plane].plane;
    return std::abs(seen.signedDistance({2.1, 0.0, 1.035})) < 0.01;
  });
}

TEST(MatchScan, TakesAPlaneForOneNearItOnlyIfDistortionCanHaveSetThemApart) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_FALSE(takesShelfForOneBelow(seed, 0.0)) << "seed " << seed;
    EXPECT_TRUE(takesShelfForOneBelow(seed, 0.004)) << "seed " << seed;
  }
}

TEST(MatchScan, APriorCountsAgainstWhatTheScanSaysThatItFixes) {
  // A prior as certain as the scan makes itself known to be, one to two sigmas off, moves the pose
  // half the way.
  test::Random random(9);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const bool with_landmarks = seed % 2 == 0;
    const ScanAndMap both =
        seeTwice(test::furnishedRoom(seed), seed, with_landmarks, options(0.003));
    PosePrior prior;
    prior.map_from_body = both.map_from_body;
    prior.information = 1e-6 * Matrix6d::Identity();
    const MatchResult alone = matchScan(both.scan, both.map, prior, RegistrationParams{});
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(alone.information);
    const Vector6d off =
        1.5 * eigen.operatorInverseSqrt() *
        Vector6d((Vector6d() << random.unitVector(), random.unitVector()).finished());
    prior.map_from_body = retract(alone.map_from_body, off);
    prior.information = alone.information;
    const MatchResult result = matchScan(both.scan, both.map, prior, RegistrationParams{});
    const Vector6d moved = difference(alone.map_from_body, result.map_from_body);
    const double share = off.dot(alone.information * moved) / off.dot(alone.information * off);
    EXPECT_NEAR(share, 0.5, 0.15) << "seed " << seed;
  }
}

TEST(MatchScan, EmptyScanOrMapKeepsThePrior) {
  const ScanAndMap both = seeTwice(test::furnishedRoom(1), 1, false, options(0.0));
  test::Random random(4);
  const PosePrior prior = perturbed(both.map_from_body, random);
  const LocalMap empty_map(kSpacing, SensorModel{}, RegistrationParams{});
  for (const MatchResult& result :
       {matchScan(ScanFeatures{}, both.map, prior, RegistrationParams{}),
        matchScan(both.scan, empty_map, prior, RegistrationParams{}),
        matchScan(ScanFeatures{}, empty_map, prior, RegistrationParams{})}) {
    EXPECT_TRUE(result.map_from_body.isApprox(prior.map_from_body, 1e-12));
    EXPECT_EQ(result.overlap, 0.0);
    EXPECT_TRUE(result.information.isZero());
    EXPECT_TRUE(result.planes.empty());
  }
}

TEST(MatchScan, RepeatsItselfToTheLastBit) {
  const ScanAndMap both = seeTwice(test::furnishedRoom(2), 2, true, options(0.003));
  test::Random random(5);
  const PosePrior prior = perturbed(both.map_from_body, random);
  const MatchResult a = matchScan(both.scan, both.map, prior, RegistrationParams{});
  const MatchResult b = matchScan(both.scan, both.map, prior, RegistrationParams{});
  EXPECT_EQ(a.map_from_body.matrix(), b.map_from_body.matrix());
  EXPECT_EQ(a.information, b.information);
}

TEST(SampleVariance, AveragesNoiseButNotItsSystematicPart) {
  OrientedCloud cloud;
  cloud.points = cloud.normals = {Eigen::Vector3f::UnitZ()};
  cloud.sigmas = {0.01F};
  cloud.weights = {4.0F};
  SensorModel sensor;
  sensor.noise_correlation = 0.5;
  EXPECT_FLOAT_EQ(sampleVariance(cloud, 0, sensor), 0.625e-4F);  // 1e-4 · (1 + 3 · 0.5) / 4
  sensor.noise_correlation = 0.0;
  EXPECT_FLOAT_EQ(sampleVariance(cloud, 0, sensor), 0.25e-4F);
}

/// What a scan saw of 64 patches of 2 cm in `rows` rows on a wall 2 m away.
ScanFeatures patchesInRows(int rows) {
  ScanFeatures scan;
  OrientedCloud& cloud = scan.cloud_in_body;
  for (int k = 0; k < 64; ++k) {
    const double row = k % rows, column = k / rows;
    cloud.points.emplace_back(2.0F, static_cast<float>(0.02 * column),
                              static_cast<float>(0.02 * row));
  }
  cloud.normals.assign(64, -Eigen::Vector3f::UnitX());
  cloud.sigmas.assign(64, 0.004F);
  cloud.weights.assign(64, 16.0F);
  cloud.spacing = 0.02;
  scan.primitives_in_body.planes.resize(1);
  scan.primitives_in_body.labels.assign(64, 0);
  return scan;
}

TEST(PlaneSamples, RimsMakeAStripUncertain) {
  SensorModel sensor;
  sensor.noise_correlation = 0.0;
  const auto weightOf = [&](int rows) {
    return planeSamples(patchesInRows(rows), sensor)[0].moments_in_body.weight();
  };
  // 64 patches of 1 mm are known to 0.125 mm. Rims put strips of 2 rows (√3 patches wide by their
  // variance) 0.112 · 20 mm / √3 = 1.3 mm off, those of 8 rows (√63 wide) 0.28 mm.
  EXPECT_NEAR(1e3 / std::sqrt(weightOf(2)), std::hypot(0.125, 1.293), 0.002);
  EXPECT_NEAR(1e3 / std::sqrt(weightOf(8)), std::hypot(0.125, 0.2822), 0.002);
}

TEST(PlaneSamples, SamplesOnALineOrAPointSayNothing) {
  EXPECT_LT(planeSamples(patchesInRows(1), SensorModel())[0].moments_in_body.weight(), 1e-3);
  ScanFeatures scan = patchesInRows(2);
  scan.primitives_in_body.labels.assign(64, -1);
  EXPECT_TRUE(planeSamples(scan, SensorModel())[0].moments_in_body.empty());
}

}  // namespace
}  // namespace opp::mapping
