// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/refinement/refine_planes.h"

#include "opp/geometry/constants.h"
#include "opp/graph/graph_params.h"

#include "support/random.h"
#include "support/refined_scene.h"
#include "support/rough_graph.h"
#include "support/synthetic_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace opp {
namespace {

using test::Rectangles;
using test::SyntheticOptions;
using test::SyntheticScene;

/// Order of its planes: −x, +x, −y, +y, −z, +z.
Rectangles room() { return test::roomSides({-2.0, -1.5, -1.2}, {2.5, 1.8, 1.3}); }

/// `rectangles` seen from the origin, in a random frame.
SyntheticScene sampled(const Rectangles& rectangles, double sigma, test::Random& random,
                       double spacing = 0.05) {
  SyntheticOptions options;
  options.sigma = sigma;
  options.spacing = spacing;
  options.normal_sigma = 0.02;
  options.seed = static_cast<std::uint64_t>(random.integer(0, 1 << 30));
  return test::sampleScene(rectangles, Eigen::Vector3d::Zero(), random.pose(2.0), options);
}

/// A floor and two walls that meet in a corner; the second wall stands at `angle` to the first.
Rectangles threeWalls(double angle) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ(), corner(-1.5, -1.5, -1.5);
  const Eigen::Vector3d along = std::cos(angle) * x + std::sin(angle) * y;
  return {{corner + 1.5 * x + 1.5 * y, 1.5 * x, 1.5 * y},
          {corner + 1.5 * x + z, z, 1.5 * x},
          {corner + 1.5 * along + z, 1.5 * along, z}};
}

/// Error of (α, β, δ), normalized by the plane's covariance: χ² with 3 degrees of freedom.
double normalizedError(const PlanePrimitive& estimate, const Plane& truth) {
  Eigen::Vector3d error;
  error << tangentBasis(estimate.plane.normal()).transpose() * truth.normal(),
      truth.d() - estimate.plane.d();
  return error.dot(estimate.covariance.ldlt().solve(error));
}

double angleOf(const Primitives& result, std::size_t a, std::size_t b) {
  return angleBetween(result.planes[a].plane, result.planes[b].plane);
}

TEST(RefinePlanes, FindsTheExactRoomFromPlanesOffByDegreesAndCentimetres) {
  test::Random random(1);
  const SyntheticScene scene = sampled(room(), 0.0, random);
  const Primitives result =
      refinePlanes(scene.cloud, test::roughGraph(scene, degToRad(4.0), 0.03, random), SensorModel(),
                   test::undistortedSensor());
  EXPECT_TRUE(result.converged);
  ASSERT_EQ(result.planes.size(), 6U);
  EXPECT_EQ(result.edges.size(), 12U);
  ASSERT_EQ(result.families.size(), 3U);
  for (std::size_t k = 0; k < 6; ++k) {
    // Coordinates are rounded to float, 1e-7 m here; a mean over thousands is better than that.
    EXPECT_LT(angleBetween(result.planes[k].plane, scene.planes[k]), 1e-7);
    EXPECT_NEAR(result.planes[k].plane.d(), scene.planes[k].d(), 2e-7);
    EXPECT_LT(result.planes[k].rms, 1e-6);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = a + 1; b < 3; ++b) {
      EXPECT_NEAR(result.families[a].normal.dot(result.families[b].normal), 0.0, 1e-12);
    }
  }
}

TEST(RefinePlanes, LabelsEverySampleOfNoisyRandomRooms) {
  test::Random random(2);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d size(random.uniform(1.0, 6.0), random.uniform(1.0, 6.0),
                               random.uniform(1.0, 6.0));
    const Eigen::Vector3d low = -size.cwiseProduct(
        Eigen::Vector3d(random.uniform(0.2, 0.8), random.uniform(0.2, 0.8), 0.5));
    const SyntheticScene scene =
        sampled(test::roomSides(low, low + size), random.uniform(0.0, 0.01), random,
                random.uniform(0.05, 0.15));
    const Primitives result =
        refinePlanes(scene.cloud, test::roughGraph(scene, degToRad(3.0), 0.03, random),
                     SensorModel(), test::undistortedSensor());
    ASSERT_EQ(result.planes.size(), 6U) << k;
    EXPECT_TRUE(result.converged) << k;
    EXPECT_EQ(result.families.size(), 3U) << k;
    std::vector<int> counts(6, 0);
    for (const int label : result.labels) {
      if (label >= 0) ++counts[static_cast<std::size_t>(label)];
    }
    std::size_t labelled = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const PlanePrimitive& plane = result.planes[i];
      EXPECT_EQ(plane.support, counts[i]);
      EXPECT_NEAR(plane.area, counts[i] * scene.cloud.spacing * scene.cloud.spacing, 1e-9);
      EXPECT_GE(plane.plane.signedDistance(scene.cloud.viewpoint.cast<double>()), 0.0);
      labelled += static_cast<std::size_t>(counts[i]);
      EXPECT_LT(normalizedError(plane, scene.planes[i]), 40.0) << k;  // χ²₃: p < 1e-8
    }
    // Tukey's cutoff of 4.7σ loses 3e-6 of the samples, the normal gate none.
    EXPECT_GT(labelled, scene.cloud.size() * 999 / 1000) << k;
  }
}

TEST(RefinePlanes, CovarianceOfConstrainedPlanesPredictsTheirErrors) {
  test::Random random(3);
  double normalized = 0.0;
  const int scans = 300;
  for (int k = 0; k < scans; ++k) {
    const SyntheticScene scene = sampled(room(), 0.005, random, 0.2);
    const Primitives result = refinePlanes(scene.cloud, test::roughGraph(scene, 0.02, 0.02, random),
                                           SensorModel(), test::undistortedSensor());
    ASSERT_EQ(result.planes.size(), 6U);
    const std::size_t i = static_cast<std::size_t>(k) % 6;
    normalized += normalizedError(result.planes[i], scene.planes[i]);
  }
  // Mean of 300 χ²₃: 3 ± 3·√(6/300) = 3 ± 0.42.
  EXPECT_NEAR(normalized / scans, 3.0, 0.42);
}

TEST(RefinePlanes, WallsThatAreNotOrthogonalKeepTheirAngle) {
  test::Random random(4);
  for (const double degrees : {86.0, 80.0, 84.0, 96.0}) {
    for (int k = 0; k < 15; ++k) {
      const SyntheticScene scene = sampled(threeWalls(degToRad(degrees)), 0.003, random);
      ASSERT_EQ(scene.planes.size(), 3U);
      PlaneGraph rough = test::roughGraph(scene, 0.03, 0.02, random);
      rough.edges.push_back({{1, 2}, 1.0});
      const Primitives result = refinePlanes(scene.cloud, rough, SensorModel(), RefinementParams());
      ASSERT_EQ(result.planes.size(), 3U);
      // 3 m walls with 3 mm noise, 2,000 samples: 0.005°.
      EXPECT_NEAR(angleOf(result, 1, 2), angleBetween(scene.planes[1], scene.planes[2]),
                  degToRad(0.03));
      EXPECT_EQ(result.edges.size(), 2U);
      EXPECT_NEAR(angleOf(result, 0, 1), kPi / 2.0, degToRad(0.03));
      EXPECT_NEAR(angleOf(result, 0, 2), kPi / 2.0, degToRad(0.03));
    }
  }
}

TEST(RefinePlanes, NearlyParallelWallsStayApartIfTheDataSaySo) {
  // 3 m walls with 3 mm noise fix their normals to 0.01°; 0.3° is seen, unless the sensor's
  // distortion could explain it.
  test::Random random(5);
  Rectangles rectangles = room();
  rectangles[1].half_u =
      Eigen::AngleAxisd(degToRad(0.3), Eigen::Vector3d::UnitZ()) * rectangles[1].half_u;
  const SyntheticScene scene = sampled(rectangles, 0.003, random);
  PlaneGraph rough = test::roughGraph(scene, 0.02, 0.02, random);
  rough.edges.push_back({{1, 2}, 1.0});
  const Primitives honest =
      refinePlanes(scene.cloud, rough, SensorModel(), test::undistortedSensor());
  ASSERT_EQ(honest.planes.size(), 6U);
  EXPECT_NE(honest.planes[0].family, honest.planes[1].family);
  EXPECT_NEAR(angleOf(honest, 0, 1), kPi - degToRad(0.3), degToRad(0.03));
  const Primitives distorted = refinePlanes(scene.cloud, rough, SensorModel(), RefinementParams());
  EXPECT_EQ(distorted.planes[0].family, distorted.planes[1].family);
}

TEST(RefinePlanes, MergesTwoPlanesOfOneSurfaceAndTheirEdges) {
  test::Random random(6);
  const SyntheticScene scene = sampled(room(), 0.003, random);
  PlaneGraph rough = test::roughGraph(scene, 0.03, 0.02, random);
  rough.nodes.push_back(test::roughGraph(scene, 0.03, 0.02, random).nodes[0]);
  rough.edges.push_back({{2, 6}, 5.0});
  const Primitives result =
      refinePlanes(scene.cloud, rough, SensorModel(), test::undistortedSensor());
  ASSERT_EQ(result.planes.size(), 6U);
  ASSERT_EQ(result.edges.size(), 12U);
  EXPECT_EQ(result.edges[0].planes, (std::array<int, 2>{0, 2}));
  EXPECT_EQ(result.edges[0].votes, 6.0);
}

TEST(RefinePlanes, FindsTheEdgesThatTheRoughGraphLacks) {
  const GraphParams params;
  test::Random random(16);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d half(random.uniform(0.8, 3.0), random.uniform(0.8, 3.0),
                               random.uniform(0.8, 3.0));
    const SyntheticScene scene =
        sampled(test::roomSides(-half, half), random.uniform(0.0, 0.01), random);
    PlaneGraph rough = test::roughGraph(scene, degToRad(3.0), 0.03, random);
    rough.edges.resize(static_cast<std::size_t>(random.uniform(0.0, 12.0)));
    const std::size_t given = rough.edges.size();
    const auto edgesOf = [&](const PlaneGraph& graph) {
      return refinePlanes(scene.cloud, graph, SensorModel(), test::undistortedSensor()).edges;
    };
    EXPECT_EQ(edgesOf(rough).size(), given) << k;  // without a rule none is added
    rough.meeting = {params.orthogonality, params.edge_reach, params.min_edge_length};
    const std::vector<OrthogonalityEdge> edges = edgesOf(rough);
    ASSERT_EQ(edges.size(), scene.edges.size()) << k;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      EXPECT_EQ(edges[i].planes, scene.edges[i]) << k;
      EXPECT_EQ(edges[i].votes, i < given ? 1.0 : 0.0) << k;
    }
  }
}

TEST(RefinePlanes, KeepsParallelSurfacesThatNoiseCanTellApart) {
  test::Random random(7);
  Rectangles rectangles = room();
  // A board 15 mm in front of the wall x = −2.
  rectangles.push_back({{-1.985, 0.1, 0.2}, {0.0, 0.5, 0.0}, {0.0, 0.0, 0.5}});
  const SyntheticScene scene = sampled(rectangles, 0.002, random);
  ASSERT_EQ(scene.planes.size(), 7U);
  const Primitives result = refinePlanes(scene.cloud, test::roughGraph(scene, 0.002, 0.002, random),
                                         SensorModel(), test::undistortedSensor());
  ASSERT_EQ(result.planes.size(), 7U);
  EXPECT_EQ(result.planes[0].family, result.planes[6].family);
  EXPECT_NEAR(std::abs(result.planes[6].plane.d() - result.planes[0].plane.d()), 0.015, 0.001);
}

TEST(RefinePlanes, SplitsAPlaneThatWasFittedBetweenTwoSurfaces) {
  test::Random random(11);
  Rectangles rectangles = room();
  rectangles.push_back({{-1.985, 0.1, 0.2}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.8}});
  const SyntheticScene scene = sampled(rectangles, 0.002, random);
  ASSERT_EQ(scene.planes.size(), 7U);
  PlaneGraph rough = test::roughGraph(scene, 0.01, 0.01, random);
  rough.nodes.pop_back();  // nobody has seen the board
  const auto gone = [](const OrthogonalityEdge& edge) { return edge.planes[1] == 6; };
  rough.edges.erase(std::remove_if(rough.edges.begin(), rough.edges.end(), gone),
                    rough.edges.end());
  const Primitives result =
      refinePlanes(scene.cloud, rough, SensorModel(), test::undistortedSensor());
  ASSERT_EQ(result.planes.size(), 7U);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.planes[0].family, result.planes[6].family);
  // 1,000 samples with 2 mm: 0.06 mm each.
  EXPECT_NEAR(std::abs(result.planes[6].plane.d() - result.planes[0].plane.d()), 0.015, 0.0005);
}

TEST(RefinePlanes, DropsStripsOfCylinders) {
  test::Random random(12);
  OrientedCloud cloud;
  cloud.spacing = 0.02;
  cloud.viewpoint = Eigen::Vector3f(2.0F, 0.0F, 0.0F);
  for (int i = 0; i < 2000; ++i) {
    const double angle = random.uniform(-1.0, 1.0), height = random.uniform(-0.5, 0.5);
    const Eigen::Vector3d normal(std::cos(angle), std::sin(angle), 0.0);
    cloud.points.push_back(Eigen::Vector3d(0.3 * normal + height * Eigen::Vector3d::UnitZ() +
                                           random.normal(0.003) * normal)
                               .cast<float>());
    cloud.normals.push_back((normal + random.vector(0.1)).normalized().cast<float>());
    cloud.sigmas.push_back(0.003F);
    cloud.weights.push_back(1.0F);
  }
  PlaneGraph rough;
  rough.nodes.resize(1);
  rough.nodes[0].plane = Plane::fromPointNormal({0.29, 0.0, 0.0}, {1.0, 0.0, 0.0});
  EXPECT_TRUE(refinePlanes(cloud, rough, SensorModel(), RefinementParams()).planes.empty());
}

TEST(RefinePlanes, KeepsAStripThatTurnsOutToBeParallelToAWall) {
  // Three samples wide, its direction is known to some 5° only: by itself it would be dropped.
  Rectangles scene_parts = room();
  scene_parts.push_back({{2.2, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 0.06, 0.0}});
  int kept = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Random random(seed);
    const SyntheticScene scene = sampled(scene_parts, 0.004, random, 0.04);
    const Primitives result =
        refinePlanes(scene.cloud, test::roughGraph(scene, degToRad(6.0), 0.0, random),
                     SensorModel(), RefinementParams());
    for (const PlanePrimitive& plane : result.planes) {
      if (plane.support < 400 && angleBetween(plane.plane, scene.planes[1]) < degToRad(0.5)) ++kept;
    }
  }
  EXPECT_EQ(kept, 20);
}

TEST(RefinePlanes, DropsPlanesWithoutSamplesAndRenumbersEdges) {
  test::Random random(8);
  const SyntheticScene scene = sampled(room(), 0.0, random);
  PlaneGraph rough = test::roughGraph(scene, 0.02, 0.02, random);
  PlaneNode ghost;
  ghost.plane = Plane::fromCoefficients({1.0, 1.0, 1.0}, 20.0);
  rough.nodes.insert(rough.nodes.begin(), ghost);
  for (OrthogonalityEdge& edge : rough.edges) {
    edge.planes = {edge.planes[0] + 1, edge.planes[1] + 1};
  }
  rough.edges.insert(rough.edges.begin(), {{0, 1}, 3.0});
  const Primitives result =
      refinePlanes(scene.cloud, rough, SensorModel(), test::undistortedSensor());
  ASSERT_EQ(result.planes.size(), 6U);
  EXPECT_EQ(result.edges.size(), 12U);
  EXPECT_LT(angleBetween(result.planes[0].plane, scene.planes[0]), 1e-6);
}

TEST(RefinePlanes, OutliersDoNotMovePlanes) {
  test::Random random(9);
  SyntheticOptions options;
  options.sigma = 0.003;
  options.outlier_ratio = 0.5;
  const SyntheticScene scene =
      test::sampleScene(room(), Eigen::Vector3d::Zero(), Eigen::Isometry3d::Identity(), options);
  const Primitives result = refinePlanes(scene.cloud, test::roughGraph(scene, 0.03, 0.03, random),
                                         SensorModel(), test::undistortedSensor());
  ASSERT_EQ(result.planes.size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    // σ/√N over some 3,000 samples is 0.05 mm.
    EXPECT_LT(angleBetween(result.planes[k].plane, scene.planes[k]), 5e-4);
    EXPECT_NEAR(result.planes[k].plane.d(), scene.planes[k].d(), 5e-4);
  }
}

TEST(RefinePlanes, DegenerateInputGivesFewerPlanes) {
  const RefinementParams params;
  EXPECT_TRUE(refinePlanes(OrientedCloud(), PlaneGraph(), SensorModel(), params).planes.empty());
  test::Random random(10);
  PlaneGraph graph;
  graph.nodes.resize(3);
  const Primitives empty_cloud = refinePlanes(OrientedCloud(), graph, SensorModel(), params);
  EXPECT_TRUE(empty_cloud.planes.empty());
  EXPECT_TRUE(empty_cloud.converged);
  OrientedCloud same;
  same.spacing = 0.05;
  for (int i = 0; i < 100; ++i) {
    same.points.emplace_back(1.0f, 2.0f, 0.0f);
    same.normals.emplace_back(0.0f, 0.0f, 1.0f);
    same.sigmas.push_back(0.001f);
    same.weights.push_back(1.0f);
  }
  graph.edges = {{{0, 1}, 1.0}};
  const Primitives one_point = refinePlanes(same, graph, SensorModel(), params);
  ASSERT_LE(one_point.planes.size(), 1U);
  for (const PlanePrimitive& plane : one_point.planes) {
    EXPECT_TRUE(plane.plane.coefficients().allFinite());
    EXPECT_TRUE(plane.covariance.allFinite());
  }
}

TEST(RefinePlanes, RejectsWrongInput) {
  PlaneGraph graph;
  graph.edges = {{{0, 1}, 1.0}};
  EXPECT_THROW(refinePlanes(OrientedCloud(), graph, SensorModel(), RefinementParams()),
               std::invalid_argument);
  OrientedCloud cloud;
  cloud.points.resize(3);
  EXPECT_THROW(refinePlanes(cloud, PlaneGraph(), SensorModel(), RefinementParams()),
               std::invalid_argument);
  RefinementParams params;
  params.normal_gate = 2.0;
  EXPECT_THROW(refinePlanes(OrientedCloud(), PlaneGraph(), SensorModel(), params),
               std::invalid_argument);
}

}  // namespace
}  // namespace opp
