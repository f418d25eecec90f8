// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/move_planar_map.h"

namespace opp::mapping {
namespace {

void moveRing(const Eigen::Isometry3d& b_from_a, std::vector<Eigen::Vector3d>& ring) {
  for (Eigen::Vector3d& vertex : ring) vertex = b_from_a * vertex;
}

}  // namespace

PlanarMap movedPlanarMap(const Eigen::Isometry3d& b_from_a, PlanarMap map_in_a) {
  PlanarMap map = std::move(map_in_a);
  const Eigen::Quaterniond rotation(b_from_a.linear());
  for (PlanarMapPlane& plane : map.planes) {
    plane.plane = transformed(b_from_a, plane.plane);
    plane.centroid = b_from_a * plane.centroid;
    for (PlanarPolygon& polygon : plane.polygons) {
      moveRing(b_from_a, polygon.outer);
      for (auto& hole : polygon.holes) moveRing(b_from_a, hole);
    }
  }
  for (PlanarMapFamily& family : map.families) family.normal = b_from_a.linear() * family.normal;
  for (PlanarMapLine& line : map.lines) {
    line.start = b_from_a * line.start;
    line.end = b_from_a * line.end;
  }
  for (PlanarMapCorner& corner : map.corners) {
    corner.position = b_from_a * corner.position;
    corner.orientation = (rotation * corner.orientation).normalized();
  }
  return map;
}

}  // namespace opp::mapping
