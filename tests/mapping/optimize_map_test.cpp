// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/backend/optimize_map.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

struct World {
  std::vector<Eigen::Isometry3d> poses;
  std::vector<Plane> planes;
  MapFactors factors;
};

/// `keyframes` poses that each see all of `planes` random planes through 60 points with `sigma`.
World randomWorld(test::Random& random, int keyframes, int planes, double sigma) {
  World world;
  for (int k = 0; k < keyframes; ++k) world.poses.push_back(random.pose(1.0));
  for (int p = 0; p < planes; ++p) {
    world.planes.push_back(Plane::fromPointNormal(random.vector(4.0), random.unitVector()));
  }
  for (int k = 0; k < keyframes; ++k) {
    for (int p = 0; p < planes; ++p) {
      const Plane& plane = world.planes[static_cast<std::size_t>(p)];
      PlaneFactor factor{k, p, {}, 60};
      for (int i = 0; i < 60; ++i) {
        const Eigen::Vector3d on_plane = plane.project(random.vector(3.0));
        const Eigen::Vector3d noisy = on_plane + random.normal() * sigma * plane.normal();
        const double weight = 1.0 / std::max(sigma * sigma, 1e-6);
        factor.moments_in_body.add(world.poses[static_cast<std::size_t>(k)].inverse() * noisy,
                                   weight);
      }
      world.factors.planes.push_back(factor);
    }
  }
  return world;
}

/// Poses from `first_free` on moved by up to 0.05 rad and 5 cm, planes by as much.
World disturbed(const World& truth, int first_free, test::Random& random) {
  World start = truth;
  for (std::size_t k = static_cast<std::size_t>(first_free); k < start.poses.size(); ++k) {
    Vector6d omega_v;
    omega_v << random.vector(0.03), random.vector(0.03);
    start.poses[k] = retract(start.poses[k], omega_v);
  }
  for (Plane& plane : start.planes) plane = perturbed(plane, random.vector(0.03));
  return start;
}

double largestPoseError(const World& a, const World& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.poses.size(); ++k) {
    largest = std::max(largest, difference(a.poses[k], b.poses[k]).norm());
  }
  return largest;
}

double largestPlaneError(const World& a, const World& b) {
  double largest = 0.0;
  for (std::size_t p = 0; p < a.planes.size(); ++p) {
    largest = std::max(largest, (a.planes[p].coefficients() - b.planes[p].coefficients()).norm());
  }
  return largest;
}

TEST(OptimizeMap, RecoversPosesAndPlanesOfExactScans) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    const World truth = randomWorld(random, 4, 6, 0.0);
    World world = disturbed(truth, 1, random);
    const OptimizationReport report =
        optimizeMap(truth.factors, 1, BackendParams{}, world.poses, world.planes);
    EXPECT_TRUE(report.converged);
    EXPECT_LT(report.final_cost, report.initial_cost);
    EXPECT_LT(largestPoseError(truth, world), 1e-5);
    EXPECT_LT(largestPlaneError(truth, world), 1e-5);
  }
}

TEST(OptimizeMap, StaysWithinTheNoiseOfTheScans) {
  test::Random random(2);
  for (int k = 0; k < 50; ++k) {
    const World truth = randomWorld(random, 4, 6, 0.005);
    World world = disturbed(truth, 1, random);
    optimizeMap(truth.factors, 1, BackendParams{}, world.poses, world.planes);
    // σ/√60 = 0.65 mm a plane; random planes may be nearly parallel, which costs up to a factor 10.
    EXPECT_LT(largestPoseError(truth, world), 0.02);
  }
}

TEST(OptimizeMap, LeavesFixedKeyframesAndUnseenPlanesAlone) {
  test::Random random(3);
  World world = randomWorld(random, 4, 6, 0.0);
  world.planes.push_back(Plane::fromPointNormal({1.0, 2.0, 3.0}, {0.0, 0.6, 0.8}));
  world.factors.orthogonalities.push_back({{0, 6}});
  const World before = disturbed(world, 1, random);
  World after = before;
  optimizeMap(world.factors, 2, BackendParams{}, after.poses, after.planes);
  EXPECT_EQ(after.poses[0].matrix(), before.poses[0].matrix());
  EXPECT_EQ(after.poses[1].matrix(), before.poses[1].matrix());
  EXPECT_NE(after.poses[2].matrix(), before.poses[2].matrix());
  EXPECT_EQ(after.planes[6].coefficients(), before.planes[6].coefficients());
}

TEST(OptimizeMap, RelativePosesCarryWhatPlanesDoNotFix) {
  test::Random random(4);
  for (int k = 0; k < 50; ++k) {
    const World truth = randomWorld(random, 3, 1, 0.0);
    World world = disturbed(truth, 1, random);
    MapFactors factors = truth.factors;
    for (int i = 0; i < 2; ++i) {
      const auto a = static_cast<std::size_t>(i);
      factors.relative_poses.push_back(
          {i, i + 1, truth.poses[a].inverse() * truth.poses[a + 1], 1e4 * Matrix6d::Identity()});
    }
    optimizeMap(factors, 1, BackendParams{}, world.poses, world.planes);
    EXPECT_LT(largestPoseError(truth, world), 1e-5);
  }
}

TEST(OptimizeMap, PullsLandmarksToTheRightAngleTheyWereSeenAt) {
  test::Random random(5);
  World world = randomWorld(random, 1, 0, 0.0);
  world.poses = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};
  world.planes = {Plane::fromCoefficients({1.0, 0.0, 0.0}, -1.0),
                  Plane::fromCoefficients({0.02, 1.0, 0.0}, -1.0)};
  // Two weak scans of the planes, off the right angle by 0.02 rad, by 1 cm of noise a point.
  for (int p = 0; p < 2; ++p) {
    PlaneFactor factor{1, p, {}, 20};
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d x =
          world.planes[static_cast<std::size_t>(p)].project(random.vector(1.0));
      factor.moments_in_body.add(x, 1.0 / (0.01 * 0.01));
    }
    world.factors.planes.push_back(factor);
  }
  world.factors.orthogonalities.push_back({{0, 1}});
  optimizeMap(world.factors, 1, BackendParams{}, world.poses, world.planes);
  // The scans fix the angle to about 0.01/√20 = 2 mrad each, the constraint to 1.7 mrad: a strong
  // pull, but no more than the data allow.
  EXPECT_LT(std::abs(world.planes[0].normal().dot(world.planes[1].normal())), 0.015);
}

TEST(OptimizeMap, IsNotMisledByOneWrongAssociation) {
  test::Random random(6);
  const World truth = randomWorld(random, 6, 8, 0.002);
  World world = disturbed(truth, 1, random);
  MapFactors factors = truth.factors;
  factors.planes[20].landmark = (factors.planes[20].landmark + 1) % 8;
  optimizeMap(factors, 1, BackendParams{}, world.poses, world.planes);
  EXPECT_LT(largestPoseError(truth, world), 0.02);
}

TEST(OptimizeMap, NamesTheFactorThatRefersToNothing) {
  std::vector<Eigen::Isometry3d> poses(2, Eigen::Isometry3d::Identity());
  std::vector<Plane> planes(1);
  MapFactors bad_keyframe, bad_landmark, bad_pose, bad_edge;
  bad_keyframe.planes.push_back({2, 0, {}, 1});
  bad_landmark.planes.push_back({1, -1, {}, 1});
  bad_pose.relative_poses.push_back({0, 5, Eigen::Isometry3d::Identity(), Matrix6d::Identity()});
  bad_edge.orthogonalities.push_back({{0, 1}});
  for (const MapFactors& factors : {bad_keyframe, bad_landmark, bad_pose, bad_edge}) {
    EXPECT_THROW(optimizeMap(factors, 1, BackendParams{}, poses, planes), std::invalid_argument);
  }
  EXPECT_THROW(optimizeMap(MapFactors{}, 0, BackendParams{}, poses, planes), std::invalid_argument);
}

TEST(OptimizeMap, NothingToOptimizeIsNoError) {
  std::vector<Eigen::Isometry3d> poses;
  std::vector<Plane> planes;
  EXPECT_TRUE(optimizeMap(MapFactors{}, 1, BackendParams{}, poses, planes).converged);
}

}  // namespace
}  // namespace opp::mapping
