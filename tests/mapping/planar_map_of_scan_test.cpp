// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/planar_map_of_scan.h"

#include "opp/mapping/io/planar_map_json.h"
#include "opp/mapping/planar/plane_kinds.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

/// A floor of 4 × 3 m at z = −1 and a wall of 3 × 2 m at x = 4, seen from the origin.
std::pair<OrientedCloud, Primitives> floorAndWall() {
  OrientedCloud cloud;
  Primitives primitives;
  cloud.spacing = 0.05;
  const auto add = [&](const Eigen::Vector3d& point, const Eigen::Vector3d& normal, int label) {
    cloud.points.push_back(point.cast<float>());
    cloud.normals.push_back(normal.cast<float>());
    cloud.sigmas.push_back(0.002F);
    cloud.weights.push_back(4.0F);
    primitives.labels.push_back(label);
  };
  for (double y = -1.475; y < 1.5; y += 0.05) {
    for (double x = 0.025; x < 4.0; x += 0.05) add({x, y, -1.0}, {0.0, 0.0, 1.0}, 0);
    for (double z = -0.975; z < 1.0; z += 0.05) add({4.0, y, z}, {-1.0, 0.0, 0.0}, 1);
  }
  primitives.planes.resize(2);
  primitives.planes[0].plane = Plane::fromPointNormal({0.0, 0.0, -1.0}, {0.0, 0.0, 1.0});
  primitives.planes[1].plane = Plane::fromPointNormal({4.0, 0.0, 0.0}, {-1.0, 0.0, 0.0});
  primitives.edges.push_back({{0, 1}, 10.0});
  primitives.lines.push_back({{0, 1}, {4.0, -1.5, -1.0}, {4.0, 1.5, -1.0}, LineKind::kConcave});
  return {cloud, primitives};
}

TEST(PlanarMapOfScan, CarriesWhatWasDetected) {
  const auto [cloud, primitives] = floorAndWall();
  const PlanarMap map =
      planarMapOfScan(cloud, primitives, PlanarParams(), 7.5, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(map.frame, "sensor");
  ASSERT_EQ(map.planes.size(), 2U);
  ASSERT_EQ(map.lines.size(), 1U);
  EXPECT_EQ(map.planes[0].orthogonal_to, std::vector<int>{1});
  EXPECT_EQ(map.planes[1].orthogonal_to, std::vector<int>{0});
  EXPECT_EQ(map.planes[0].kind, PlaneKind::kHorizontal);
  EXPECT_EQ(map.planes[1].kind, PlaneKind::kVertical);
  EXPECT_EQ(map.planes[0].points, 80 * 60 * 4);
  EXPECT_EQ(map.planes[0].observations, std::vector<double>{7.5});
  EXPECT_NEAR(map.planes[0].area, 12.0, 0.5);  // a cell around an outline of 14 m
  EXPECT_NEAR(map.planes[1].area, 6.0, 0.4);
  EXPECT_LT((map.planes[1].centroid - Eigen::Vector3d(4.0, 0.0, 0.0)).norm(), 0.05);
  EXPECT_NO_THROW(parsePlanarMap(formatPlanarMap(map), "map"));
}

TEST(PlanarMapOfScan, WithoutGravityPlanesAreOther) {
  const auto [cloud, primitives] = floorAndWall();
  const PlanarMap map = planarMapOfScan(cloud, primitives, PlanarParams());
  EXPECT_EQ(map.planes[0].kind, PlaneKind::kOther);
}

TEST(PlanarMapOfScan, NothingDetectedIsAnEmptyMap) {
  EXPECT_TRUE(planarMapOfScan({}, {}, PlanarParams()).planes.empty());
  const auto [cloud, primitives] = floorAndWall();
  EXPECT_THROW(planarMapOfScan(cloud, {}, PlanarParams()), std::invalid_argument);
}

TEST(PlaneKinds, TellFloorTableCeilingAndWallApart) {
  const auto [cloud, primitives] = floorAndWall();
  PlanarMap map = planarMapOfScan(cloud, primitives, PlanarParams());
  const auto add = [&](double z, double facing, double tilt) {
    PlanarMapPlane plane;
    plane.id = static_cast<int>(map.planes.size());
    plane.plane =
        Plane::fromPointNormal({0.0, 0.0, z}, {std::sin(tilt), 0.0, facing * std::cos(tilt)});
    plane.centroid = {0.0, 0.0, z};
    plane.area = 1.0;
    map.planes.push_back(plane);
  };
  add(-0.3, 1.0, 0.0);  // table
  add(1.5, -1.0, 0.0);  // ceiling
  add(0.0, 1.0, 0.7);   // ramp
  const auto up = estimateUp(map, Eigen::Vector3d(0.3, 0.0, 1.0), PlanarParams());
  ASSERT_TRUE(up);
  EXPECT_LT((*up - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  classifyPlanes(map, *up, PlanarParams());
  EXPECT_EQ(map.planes[0].kind, PlaneKind::kFloor);
  EXPECT_EQ(map.planes[1].kind, PlaneKind::kWall);
  EXPECT_EQ(map.planes[2].kind, PlaneKind::kHorizontal);
  EXPECT_EQ(map.planes[3].kind, PlaneKind::kCeiling);
  EXPECT_EQ(map.planes[4].kind, PlaneKind::kOther);
  EXPECT_FALSE(estimateUp(PlanarMap(), Eigen::Vector3d::UnitZ(), PlanarParams()));
}

}  // namespace
}  // namespace opp::mapping
