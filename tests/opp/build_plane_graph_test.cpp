// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/graph/build_plane_graph.h"

#include "opp/geometry/constants.h"

#include "support/degenerate_clouds.h"
#include "support/random.h"
#include "support/synthetic_room.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp {
namespace {

PlaneGraph graphOf(const OrientedCloud& cloud) {
  const OppHypotheses hypotheses = detectOpps(cloud, SensorModel{}, VotingParams{});
  return buildPlaneGraph(cloud, hypotheses, SensorModel{}, GraphParams{});
}

/// Index of the true plane within the given errors; −1: none.
int matchOf(const test::SyntheticScene& scene, const Plane& plane, double angle, double offset) {
  for (std::size_t p = 0; p < scene.planes.size(); ++p) {
    if (angleBetween(scene.planes[p], plane) < angle &&
        std::abs(scene.planes[p].d() - plane.d()) < offset) {
      return static_cast<int>(p);
    }
  }
  return -1;
}

TEST(BuildPlaneGraph, RoomFromInsideIsExact) {
  const test::SyntheticScene scene =
      test::sampleScene(test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5}), {0.3, 0.2, 1.2},
                        Eigen::Isometry3d::Identity(), {});
  const PlaneGraph graph = graphOf(scene.cloud);
  ASSERT_EQ(graph.nodes.size(), 6U);
  EXPECT_EQ(graph.edges.size(), 12U);
  for (const PlaneNode& node : graph.nodes) {
    // float32 points within 3 m.
    EXPECT_GE(matchOf(scene, node.plane, 1e-6, 1e-6), 0) << node.plane;
  }
}

TEST(BuildPlaneGraph, CubeFromOutsideIsExact) {
  const test::SyntheticScene scene =
      test::sampleScene(test::boxSides({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), {2.0, 1.8, 1.6},
                        Eigen::Isometry3d::Identity(), {});
  const PlaneGraph graph = graphOf(scene.cloud);
  ASSERT_EQ(graph.nodes.size(), 3U);
  EXPECT_EQ(graph.edges.size(), 3U);
  for (const PlaneNode& node : graph.nodes) {
    EXPECT_GE(matchOf(scene, node.plane, 1e-6, 1e-6), 0) << node.plane;
    EXPECT_GT(node.plane.signedDistance(scene.cloud.viewpoint.cast<double>()), 0.0);
  }
}

TEST(BuildPlaneGraph, FindsExactlyTheWallsOfNoisyRandomRooms) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const Eigen::Vector3d high(random.uniform(1.2, 3.0), random.uniform(1.2, 3.0),
                               random.uniform(1.0, 1.6));
    test::SyntheticOptions options;
    options.sigma = random.uniform(0.001, 0.008);
    options.normal_sigma = degToRad(random.uniform(0.5, 5.0));
    options.outlier_ratio = 0.05;
    options.seed = seed;
    const test::SyntheticScene scene = test::sampleScene(
        test::roomSides(-high, high), random.vector(0.8), random.pose(3.0), options);
    const PlaneGraph graph = graphOf(scene.cloud);
    EXPECT_EQ(graph.nodes.size(), 6U);
    EXPECT_EQ(graph.edges.size(), 12U);
    for (const PlaneNode& node : graph.nodes) {
      // ≥ 1900 samples per wall of ≥ 2 m: σ/√1900 over 0.6 m is 0.02° and, some 6 m from the
      // origin, 2 mm. A fivefold error is allowed.
      EXPECT_GE(matchOf(scene, node.plane, degToRad(0.1), 0.01), 0) << node.plane;
    }
  }
}

TEST(BuildPlaneGraph, ParallelSurfacesStayApart) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const double step = random.uniform(0.08, 0.15);
    // Three steps of a stair, seen from above: treads 8 to 15 cm above each other.
    test::Rectangles treads;
    for (int k = 0; k < 3; ++k) {
      treads.push_back({{0.8 * k, 0.0, step * k}, {0.4, 0.0, 0.0}, {0.0, 0.8, 0.0}});
    }
    test::SyntheticOptions options;
    options.sigma = 0.005;
    options.normal_sigma = degToRad(5.0);
    options.seed = seed;
    const test::SyntheticScene scene =
        test::sampleScene(treads, {0.8, 0.0, 2.5}, random.pose(2.0), options);
    const PlaneGraph graph = graphOf(scene.cloud);
    EXPECT_EQ(graph.nodes.size(), 3U);
    for (const PlaneNode& node : graph.nodes) {
      // 512 samples over 0.8 × 1.6 m: 0.06°; 5 mm at the origin, up to 4 m away. Fivefold.
      EXPECT_GE(matchOf(scene, node.plane, degToRad(0.3), 0.025), 0) << node.plane;
    }
  }
}

TEST(BuildPlaneGraph, SurfacesOfUnlikeHeightSideBySideAreNotOneSlantedPlane) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    // Farther apart than reference points look: a plane that slants by half a degree passes
    // through both and leaves 1 mm or more at their rims, five times the noise.
    const double step = random.uniform(0.011, 0.014);
    const test::Rectangles tops{{{0.0, 0.0, 0.0}, {0.2, 0.0, 0.0}, {0.0, 0.3, 0.0}},
                                {{1.2, 0.0, step}, {0.2, 0.0, 0.0}, {0.0, 0.3, 0.0}}};
    test::SyntheticOptions options;
    options.spacing = 0.02;
    options.sigma = 0.0002;
    options.normal_sigma = degToRad(2.0);
    options.seed = seed;
    const test::SyntheticScene scene =
        test::sampleScene(tops, {0.6, 0.0, 2.0}, random.pose(1.0), options);
    const PlaneGraph graph = graphOf(scene.cloud);
    EXPECT_EQ(graph.nodes.size(), 2U);
    for (const PlaneNode& node : graph.nodes) {
      // 600 samples over 0.4 × 0.6 m: 0.004°; 0.2 mm at the origin, up to 3 m away. Fivefold.
      EXPECT_GE(matchOf(scene, node.plane, degToRad(0.02), 0.001), 0) << node.plane;
    }
  }
}

TEST(BuildPlaneGraph, SignsOfNormalsDoNotMatter) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    test::SyntheticOptions options;
    options.sigma = 0.004;
    options.normal_sigma = degToRad(3.0);
    options.flip_normals = true;
    options.seed = seed;
    test::Random random(seed);
    const test::SyntheticScene scene =
        test::sampleScene(test::roomSides({-2.0, -1.5, 0.0}, {2.0, 1.5, 2.5}), {0.3, 0.2, 1.2},
                          random.pose(2.0), options);
    const PlaneGraph graph = graphOf(scene.cloud);
    EXPECT_EQ(graph.nodes.size(), 6U);
    EXPECT_EQ(graph.edges.size(), 12U);
    for (const PlaneNode& node : graph.nodes) {
      EXPECT_GE(matchOf(scene, node.plane, degToRad(0.1), 0.01), 0) << node.plane;
    }
  }
}

TEST(BuildPlaneGraph, DegenerateCloudsGiveFinitePlanes) {
  for (const auto& [name, cloud] : test::degenerateClouds()) {
    SCOPED_TRACE(name);
    for (const PlaneNode& node : graphOf(cloud).nodes) {
      EXPECT_TRUE(node.plane.coefficients().allFinite());
    }
  }
}

TEST(BuildPlaneGraph, OnePlaneAndTwoParallelPlanesAreLone) {
  for (const auto& [name, cloud] : test::degenerateClouds()) {
    const PlaneGraph graph = graphOf(cloud);
    if (name == "one plane") {
      EXPECT_EQ(graph.nodes.size(), 1U);
    }
    if (name == "two parallel planes") {
      EXPECT_EQ(graph.nodes.size(), 2U);
    }
    if (name == "collinear" || name == "all equal" || name == "clutter") {
      EXPECT_TRUE(graph.nodes.empty()) << name;
    }
    EXPECT_TRUE(graph.edges.empty()) << name;
  }
}

TEST(BuildPlaneGraph, RejectsParametersOutOfRange) {
  GraphParams params;
  params.rounds = 0;
  EXPECT_THROW(buildPlaneGraph({}, {}, SensorModel{}, params), std::invalid_argument);
}

}  // namespace
}  // namespace opp
