// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/refinement/refine_planes.h"

#include "opp/geometry/constants.h"

#include "support/random.h"
#include "support/rectangle_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace opp {
namespace {

using test::RectangleScene;

/// Independent noise, no distortion: what the scenes of these tests have.
RefinementParams idealSensor() {
  RefinementParams params;
  params.noise_correlation = 0.0;
  params.systematic_angle = 0.0;
  return params;
}

RectangleScene room() { return test::boxScene({-2.0, -1.5, -1.2}, {2.5, 1.8, 1.3}); }

RectangleScene randomRoom(test::Random& random) {
  const Eigen::Vector3d high(random.uniform(0.5, 3.0), random.uniform(0.5, 3.0),
                             random.uniform(0.5, 3.0));
  const Eigen::Vector3d low(-random.uniform(0.5, 3.0), -random.uniform(0.5, 3.0),
                            -random.uniform(0.5, 3.0));
  return test::boxScene(low, high).transformed(random.pose(2.0));
}

/// A floor and two walls that meet it; the second wall stands at `angle` to the first.
RectangleScene threeWalls(double angle) {
  RectangleScene scene;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d along = std::cos(angle) * x + std::sin(angle) * y;
  scene.rectangles = {{Eigen::Vector3d::Zero(), 3.0 * x, 3.0 * y},
                      {Eigen::Vector3d::Zero(), 3.0 * x, 2.0 * z},
                      {Eigen::Vector3d::Zero(), 3.0 * along, 2.0 * z}};
  scene.edges = {{0, 1}, {0, 2}, {1, 2}};
  scene.viewpoint = {1.5, 1.5, 1.5};
  scene.sigma = 0.003;
  return scene;
}

double angleOf(const Primitives& result, std::size_t a, std::size_t b) {
  return angleBetween(result.planes[a].plane, result.planes[b].plane);
}

TEST(RefinePlanes, FindsTheExactRoomFromPlanesOffByDegreesAndCentimetres) {
  test::Random random(1);
  const RectangleScene scene = room();
  const OrientedCloud cloud = scene.sample(random);
  const Primitives result =
      refinePlanes(cloud, scene.rough(random, degToRad(4.0), 0.03), idealSensor());
  EXPECT_TRUE(result.converged);
  ASSERT_EQ(result.planes.size(), 6u);
  EXPECT_EQ(result.edges.size(), 12u);
  ASSERT_EQ(result.families.size(), 3u);
  for (std::size_t k = 0; k < 6; ++k) {
    // Coordinates are rounded to float, 1e-7 m here; a mean over thousands is better than that.
    EXPECT_LT(angleBetween(result.planes[k].plane, scene.plane(k)), 1e-7);
    EXPECT_NEAR(result.planes[k].plane.d(), scene.plane(k).d(), 1e-7);
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
    RectangleScene scene = randomRoom(random);
    scene.sigma = random.uniform(0.0, 0.01);
    scene.spacing = random.uniform(0.05, 0.15);
    const OrientedCloud cloud = scene.sample(random);
    const Primitives result =
        refinePlanes(cloud, scene.rough(random, degToRad(3.0), 0.03), idealSensor());
    ASSERT_EQ(result.planes.size(), 6u) << k;
    EXPECT_TRUE(result.converged) << k;
    EXPECT_EQ(result.families.size(), 3u) << k;
    std::vector<int> counts(6, 0);
    for (const int label : result.labels) {
      if (label >= 0) ++counts[static_cast<std::size_t>(label)];
    }
    std::size_t labelled = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const PlanePrimitive& plane = result.planes[i];
      EXPECT_EQ(plane.support, counts[i]);
      EXPECT_NEAR(plane.area, counts[i] * cloud.spacing * cloud.spacing, 1e-9);
      EXPECT_GE(plane.plane.signedDistance(scene.viewpoint), 0.0);
      labelled += static_cast<std::size_t>(counts[i]);
      // Normalized error of the constrained plane, χ² with 3 degrees of freedom: 40 is p < 1e-8.
      const Plane truth = scene.plane(i);
      Eigen::Vector3d error;
      error << tangentBasis(plane.plane.normal()).transpose() * truth.normal(),
          truth.d() - plane.plane.d();
      EXPECT_LT(error.dot(plane.covariance.ldlt().solve(error)), 40.0) << k;
    }
    // Tukey's cutoff of 4.7σ loses 3e-6 of the samples, the normal gate none.
    EXPECT_GT(labelled, cloud.size() * 999 / 1000) << k;
  }
}

TEST(RefinePlanes, CovarianceOfConstrainedPlanesPredictsTheirErrors) {
  test::Random random(3);
  double normalized = 0.0;
  const int scans = 300;
  for (int k = 0; k < scans; ++k) {
    RectangleScene scene = room().transformed(random.pose(2.0));
    scene.sigma = 0.005;
    scene.spacing = 0.2;
    const OrientedCloud cloud = scene.sample(random);
    const Primitives result = refinePlanes(cloud, scene.rough(random, 0.02, 0.02), idealSensor());
    ASSERT_EQ(result.planes.size(), 6u);
    const std::size_t i = static_cast<std::size_t>(k) % 6;
    const Plane truth = scene.plane(i);
    Eigen::Vector3d error;
    error << tangentBasis(result.planes[i].plane.normal()).transpose() * truth.normal(),
        truth.d() - result.planes[i].plane.d();
    normalized += error.dot(result.planes[i].covariance.ldlt().solve(error));
  }
  // Mean of 300 χ²₃: 3 ± 3·√(6/300) = 3 ± 0.42.
  EXPECT_NEAR(normalized / scans, 3.0, 0.42);
}

TEST(RefinePlanes, WallsThatAreNotOrthogonalKeepTheirAngle) {
  test::Random random(4);
  for (const double degrees : {86.0, 80.0, 84.0, 96.0}) {
    for (int k = 0; k < 15; ++k) {
      const RectangleScene scene = threeWalls(degToRad(degrees)).transformed(random.pose(1.0));
      const Primitives result =
          refinePlanes(scene.sample(random), scene.rough(random, 0.03, 0.02), RefinementParams());
      ASSERT_EQ(result.planes.size(), 3u);
      EXPECT_NEAR(angleOf(result, 1, 2), angleBetween(scene.plane(1), scene.plane(2)),
                  degToRad(0.1));
      EXPECT_EQ(result.edges.size(), 2u);
      EXPECT_NEAR(angleOf(result, 0, 1), kPi / 2.0, degToRad(0.1));
      EXPECT_NEAR(angleOf(result, 0, 2), kPi / 2.0, degToRad(0.1));
    }
  }
}

TEST(RefinePlanes, NearlyParallelWallsStayApartIfTheDataSaySo) {
  // 3 m walls with 3 mm noise fix their normals to 0.01°; 0.3° is seen, unless the sensor's
  // distortion could explain it.
  test::Random random(5);
  RectangleScene scene = room();
  scene.sigma = 0.003;
  scene.rectangles[1].u += Eigen::Vector3d(std::tan(degToRad(0.3)) * 3.3, 0.0, 0.0);
  const OrientedCloud cloud = scene.sample(random);
  const PlaneGraph rough = scene.rough(random, 0.02, 0.02);
  const Primitives honest = refinePlanes(cloud, rough, idealSensor());
  ASSERT_EQ(honest.planes.size(), 6u);
  EXPECT_NE(honest.planes[0].family, honest.planes[1].family);
  EXPECT_NEAR(angleOf(honest, 0, 1), kPi - degToRad(0.3), degToRad(0.03));
  const Primitives distorted = refinePlanes(cloud, rough, RefinementParams());
  EXPECT_EQ(distorted.planes[0].family, distorted.planes[1].family);
}

TEST(RefinePlanes, MergesTwoPlanesOfOneSurfaceAndTheirEdges) {
  test::Random random(6);
  RectangleScene scene = room();
  scene.sigma = 0.003;
  const OrientedCloud cloud = scene.sample(random);
  PlaneGraph rough = scene.rough(random, 0.03, 0.02);
  rough.nodes.push_back(scene.rough(random, 0.03, 0.02).nodes[0]);
  rough.edges.push_back({{2, 6}, 5.0});
  const Primitives result = refinePlanes(cloud, rough, idealSensor());
  ASSERT_EQ(result.planes.size(), 6u);
  ASSERT_EQ(result.edges.size(), 12u);
  EXPECT_EQ(result.edges[0].planes, (std::array<int, 2>{0, 2}));
  EXPECT_EQ(result.edges[0].votes, 6.0);
}

TEST(RefinePlanes, KeepsParallelSurfacesThatNoiseCanTellApart) {
  test::Random random(7);
  RectangleScene scene = room();
  scene.sigma = 0.002;
  // A board 15 mm in front of the wall x = −2.
  scene.rectangles.push_back(
      {{-1.985, -0.5, -0.5}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()});
  const Primitives result =
      refinePlanes(scene.sample(random), scene.rough(random, 0.002, 0.002), idealSensor());
  ASSERT_EQ(result.planes.size(), 7u);
  EXPECT_EQ(result.planes[0].family, result.planes[6].family);
  EXPECT_NEAR(std::abs(result.planes[6].plane.d() - result.planes[0].plane.d()), 0.015, 0.001);
}

TEST(RefinePlanes, DropsPlanesWithoutSamplesAndRenumbersEdges) {
  test::Random random(8);
  const RectangleScene scene = room();
  const OrientedCloud cloud = scene.sample(random);
  PlaneGraph rough = scene.rough(random, 0.02, 0.02);
  PlaneNode ghost;
  ghost.plane = Plane::fromCoefficients({1.0, 1.0, 1.0}, 20.0);
  rough.nodes.insert(rough.nodes.begin(), ghost);
  for (OrthogonalityEdge& edge : rough.edges) {
    edge.planes = {edge.planes[0] + 1, edge.planes[1] + 1};
  }
  rough.edges.insert(rough.edges.begin(), {{0, 1}, 3.0});
  const Primitives result = refinePlanes(cloud, rough, idealSensor());
  EXPECT_EQ(result.planes.size(), 6u);
  EXPECT_EQ(result.edges.size(), 12u);
  EXPECT_LT(angleBetween(result.planes[0].plane, scene.plane(0)), 1e-6);
}

TEST(RefinePlanes, OutliersDoNotMovePlanes) {
  test::Random random(9);
  RectangleScene scene = room();
  scene.sigma = 0.003;
  OrientedCloud cloud = scene.sample(random);
  const std::size_t clean = cloud.size();
  for (std::size_t i = 0; i < clean / 2; ++i) {
    cloud.points.push_back(random.vector(1.5).cast<float>());
    cloud.normals.push_back(random.unitVector().cast<float>());
    cloud.sigmas.push_back(0.003f);
    cloud.weights.push_back(1.0f);
  }
  const Primitives result = refinePlanes(cloud, scene.rough(random, 0.03, 0.03), idealSensor());
  ASSERT_EQ(result.planes.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    // σ/√N over some 1,000 samples is 0.1 mm.
    EXPECT_LT(angleBetween(result.planes[k].plane, scene.plane(k)), 5e-4);
    EXPECT_NEAR(result.planes[k].plane.d(), scene.plane(k).d(), 5e-4);
  }
}

TEST(RefinePlanes, DegenerateInputGivesFewerPlanes) {
  const RefinementParams params;
  EXPECT_TRUE(refinePlanes(OrientedCloud(), PlaneGraph(), params).planes.empty());
  test::Random random(10);
  PlaneGraph graph;
  graph.nodes.resize(3);
  const Primitives empty_cloud = refinePlanes(OrientedCloud(), graph, params);
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
  const Primitives one_point = refinePlanes(same, graph, params);
  ASSERT_LE(one_point.planes.size(), 1u);
  for (const PlanePrimitive& plane : one_point.planes) {
    EXPECT_TRUE(plane.plane.coefficients().allFinite());
    EXPECT_TRUE(plane.covariance.allFinite());
  }
}

TEST(RefinePlanes, RejectsWrongInput) {
  PlaneGraph graph;
  graph.edges = {{{0, 1}, 1.0}};
  EXPECT_THROW(refinePlanes(OrientedCloud(), graph, RefinementParams()), std::invalid_argument);
  OrientedCloud cloud;
  cloud.points.resize(3);
  EXPECT_THROW(refinePlanes(cloud, PlaneGraph(), RefinementParams()), std::invalid_argument);
  RefinementParams params;
  params.normal_gate = 2.0;
  EXPECT_THROW(refinePlanes(OrientedCloud(), PlaneGraph(), params), std::invalid_argument);
}

}  // namespace
}  // namespace opp
