// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/move_planar_map.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

Eigen::Matrix3d randomCovariance(test::Random& random) {
  Eigen::Matrix3d root;
  for (int k = 0; k < 3; ++k) root.col(k) = random.vector(1.0);
  return root * root.transpose();
}

PlanarMap randomMap(test::Random& random) {
  PlanarMap map;
  map.planes.resize(1);
  PlanarMapPlane& plane = map.planes[0];
  plane.plane = Plane::fromPointNormal(random.vector(3.0), random.unitVector());
  plane.centroid = plane.plane.project(random.vector(3.0));
  plane.polygons.resize(1);
  for (int k = 0; k < 3; ++k) {
    plane.polygons[0].outer.push_back(plane.plane.project(random.vector(3.0)));
  }
  plane.polygons[0].holes = {plane.polygons[0].outer};
  plane.covariance = randomCovariance(random);
  map.families.resize(1);
  map.families[0].normal = plane.plane.normal();
  map.lines.resize(1);
  map.lines[0].start = random.vector(3.0);
  map.lines[0].end = random.vector(3.0);
  map.corners.resize(1);
  map.corners[0].position = random.vector(3.0);
  map.corners[0].orientation = Eigen::Quaterniond(random.rotation());
  map.corners[0].covariance = randomCovariance(random);
  map.barely_seen = {map.planes, map.lines, map.corners};
  return map;
}

TEST(MovedPlanarMap, MovesWhatLiesOnAPlaneWithThePlane) {
  test::Random random(141);
  for (int k = 0; k < 50; ++k) {
    const PlanarMap a = randomMap(random);
    const Eigen::Isometry3d b_from_a = random.pose(5.0);
    const PlanarMap b = movedPlanarMap(b_from_a, a);
    const PlanarMapPlane& plane = b.planes[0];
    EXPECT_NEAR(plane.plane.signedDistance(plane.centroid), 0.0, 1e-12);
    for (const auto& ring : {plane.polygons[0].outer, plane.polygons[0].holes[0]}) {
      for (const auto& vertex : ring) {
        EXPECT_NEAR(plane.plane.signedDistance(vertex), 0.0, 1e-12);
      }
    }
    EXPECT_TRUE(b.families[0].normal.isApprox(plane.plane.normal(), 1e-12));
    EXPECT_TRUE(b.lines[0].start.isApprox(b_from_a * a.lines[0].start, 1e-12));
    EXPECT_TRUE(b.corners[0].position.isApprox(b_from_a * a.corners[0].position, 1e-12));
    EXPECT_EQ(b.barely_seen.planes[0].centroid, plane.centroid);
    EXPECT_EQ(b.barely_seen.lines[0].end, b.lines[0].end);
    EXPECT_EQ(b.barely_seen.corners[0].position, b.corners[0].position);
  }
}

TEST(MovedPlanarMap, ThereAndBackIsTheSameCovariancesIncluded) {
  test::Random random(142);
  for (int k = 0; k < 50; ++k) {
    const PlanarMap a = randomMap(random);
    const Eigen::Isometry3d b_from_a = random.pose(5.0);
    const PlanarMap back = movedPlanarMap(b_from_a.inverse(), movedPlanarMap(b_from_a, a));
    EXPECT_TRUE(
        back.planes[0].plane.coefficients().isApprox(a.planes[0].plane.coefficients(), 1e-12));
    // Squares of coordinates of 5 m amplify rounding.
    EXPECT_TRUE(back.planes[0].covariance.isApprox(a.planes[0].covariance, 1e-9));
    EXPECT_TRUE(back.corners[0].covariance.isApprox(a.corners[0].covariance, 1e-9));
    EXPECT_NEAR(std::abs(back.corners[0].orientation.dot(a.corners[0].orientation)), 1.0, 1e-12);
  }
}

TEST(MovedPlanarMap, CovarianceOfAPlaneIsThatOfItsMovedPerturbations) {
  // Σ = e e' for a perturbation e: in frame b it must be e_b e_b' of the moved perturbed plane.
  test::Random random(143);
  for (int k = 0; k < 50; ++k) {
    PlanarMap a = randomMap(random);
    const Eigen::Isometry3d b_from_a = random.pose(5.0);
    const double size = 1e-6;
    const Eigen::Vector3d e = size * random.unitVector();
    a.planes[0].covariance = e * e.transpose();
    const PlanarMap b = movedPlanarMap(b_from_a, a);
    const Plane& plane = b.planes[0].plane;
    const Plane shaken = transformed(b_from_a, perturbed(a.planes[0].plane, e));
    Eigen::Vector3d e_b;
    e_b << tangentBasis(plane.normal()).transpose() * shaken.normal(), shaken.d() - plane.d();
    // Second-order terms are of size² · 5 m; squared differences of 1e-6 carry rounding of 1e-16.
    EXPECT_LT((b.planes[0].covariance - e_b * e_b.transpose()).norm(), 1e-3 * size * size);
  }
}

TEST(MovedPlanarMap, AnEmptyMapStaysEmpty) {
  const PlanarMap map = movedPlanarMap(Eigen::Isometry3d::Identity(), {});
  EXPECT_TRUE(map.planes.empty());
  EXPECT_EQ(map.frame, "map");
}

}  // namespace
}  // namespace opp::mapping
