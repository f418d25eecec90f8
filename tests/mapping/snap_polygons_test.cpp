// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/snap_polygons.h"

#include "opp/mapping/core/move_planar_map.h"
#include "opp/mapping/planar/build_polygons.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

/// A floor [0, 4] × [0, 3] and a wall at x = 4 of height 2 that meet in a line. Outlines near the
/// line are ragged by up to 6 cm.
PlanarMap raggedRoom(test::Random& random) {
  PlanarMap map;
  map.planes.resize(2);
  for (int id = 0; id < 2; ++id) map.planes[static_cast<std::size_t>(id)].id = id;
  map.planes[0].plane = Plane::fromPointNormal({0, 0, 0}, {0, 0, 1});
  map.planes[1].plane = Plane::fromPointNormal({4, 0, 0}, {-1, 0, 0});
  std::vector<Eigen::Vector3d> floor{{0, 3, 0}, {0, 0, 0}};
  std::vector<Eigen::Vector3d> wall{{4, 0, 2}, {4, 3, 2}};
  for (double y = 0.0; y < 3.01; y += 0.25) {
    floor.push_back({4.0 + random.uniform(-0.06, 0.06), y, 0});
    wall.push_back({4, 3.0 - y, random.uniform(-0.06, 0.06)});
  }
  map.planes[0].polygons = {{floor, {}}};
  map.planes[1].polygons = {{wall, {}}};
  map.lines = {{0, {0, 1}, {4, 0, 0}, {4, 3, 0}, LineKind::kConcave}};
  return map;
}

/// Vertices of a polygon within 2 nm of the line x = 4, z = 0: coordinates have a grid of 1 nm.
int verticesOnTheLine(const PlanarMapPlane& plane, const Eigen::Isometry3d& room_from_map) {
  int count = 0;
  for (const Eigen::Vector3d& vertex : plane.polygons.at(0).outer) {
    const Eigen::Vector3d in_room = room_from_map * vertex;
    if (std::hypot(in_room.x() - 4.0, in_room.z()) < 2e-9) ++count;
  }
  return count;
}

TEST(SnapPolygons, ANarrowStripKeepsItsWidth) {
  // The front of a board, 3 cm high, between two lines that are both within `snap` of its outline.
  PlanarMap map;
  map.planes.resize(3);
  for (int id = 0; id < 3; ++id) map.planes[static_cast<std::size_t>(id)].id = id;
  map.planes[0].plane = Plane::fromPointNormal({0, 0, 0}, {-1, 0, 0});
  map.planes[0].polygons = {{{{0, 0, 0.001}, {0, 0, 0.029}, {0, 0.9, 0.029}, {0, 0.9, 0.001}}, {}}};
  map.lines = {{0, {0, 1}, {0, 0, 0.03}, {0, 0.9, 0.03}, LineKind::kConvex},
               {1, {0, 2}, {0, 0, 0}, {0, 0.9, 0}, LineKind::kConvex}};
  snapPolygons(map, PlanarParams());
  ASSERT_EQ(map.planes[0].polygons.size(), 1U);
  EXPECT_NEAR(map.planes[0].area, 0.9 * 0.03, 1e-7);
}

TEST(SnapPolygons, NeighboursShareTheirEdge) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d map_from_room = random.pose(3.0);
    PlanarMap map = movedPlanarMap(map_from_room, raggedRoom(random));
    snapPolygons(map, PlanarParams());
    for (const PlanarMapPlane& plane : map.planes) {
      ASSERT_EQ(plane.polygons.size(), 1U);
      EXPECT_EQ(plane.polygons[0].outer.size(), 4U) << "vertices along the edge are dropped";
      EXPECT_EQ(verticesOnTheLine(plane, map_from_room.inverse()), 2);
      EXPECT_NEAR(plane.area, plane.id == 0 ? 12.0 : 6.0, 1e-7);
      EXPECT_NEAR(plane.area, areaOf(plane.polygons, plane.plane.normal()), 1e-12);
    }
  }
}

TEST(SnapPolygons, CornerGoesBeforeLine) {
  test::Random random(2);
  PlanarMap map = raggedRoom(random);
  PlanarMapCorner corner;
  corner.planes = {0, 1, 2};
  corner.position = {4, -0.05, 0};  // the third plane is at y = −0.05
  map.corners.push_back(corner);
  snapPolygons(map, PlanarParams());
  for (const PlanarMapPlane& plane : map.planes) {
    const auto& outer = plane.polygons.at(0).outer;
    EXPECT_TRUE(std::any_of(outer.begin(), outer.end(), [&](const Eigen::Vector3d& vertex) {
      return (vertex - corner.position).norm() < 2e-9;
    }));
  }
}

TEST(SnapPolygons, OutlinesFarFromLinesStay) {
  test::Random random(3);
  PlanarMap map = raggedRoom(random);
  map.lines[0].start.x() = map.lines[0].end.x() = 5.0;
  const auto before = map.planes[0].polygons[0].outer;
  snapPolygons(map, PlanarParams());
  EXPECT_NEAR(areaOf(map.planes[0].polygons, Eigen::Vector3d::UnitZ()),
              areaOf({{before, {}}}, Eigen::Vector3d::UnitZ()), 1e-7);
  PlanarMap empty;
  snapPolygons(empty, PlanarParams());
  EXPECT_TRUE(empty.planes.empty());
}

TEST(SnapPolygons, PolygonThatWouldVanishStays) {
  PlanarMap map;
  map.planes.resize(1);
  map.planes[0].polygons = {{{{0, 0, 0}, {2, 0, 0}, {2, 0.09, 0}, {0, 0.09, 0}}, {}}};
  map.lines = {{0, {0, 1}, {0, 0, 0}, {2, 0, 0}, LineKind::kUnknown}};
  snapPolygons(map, PlanarParams());
  EXPECT_EQ(map.planes[0].polygons.size(), 1U);
}

}  // namespace
}  // namespace opp::mapping
