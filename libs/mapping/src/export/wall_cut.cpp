// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/wall_cut.h"

#include <algorithm>

namespace opp::mapping {
namespace {

/// Level direction along a plumb plane.
Eigen::Vector2d directionOf(const PlanarMapPlane& plane) {
  const Eigen::Vector3d& normal = plane.plane.normal();
  return Eigen::Vector2d(-normal.y(), normal.x()).normalized();
}

void addCrossings(double z, const std::vector<Eigen::Vector3d>& ring,
                  std::vector<Eigen::Vector3d>& crossings) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector3d& a = ring[i];
    const Eigen::Vector3d& b = ring[(i + 1) % ring.size()];
    if ((a.z() > z) == (b.z() > z)) continue;
    crossings.push_back(a + (z - a.z()) / (b.z() - a.z()) * (b - a));
  }
}

}  // namespace

std::vector<WallStretch> cutAt(double z, const PlanarMapPlane& plane) {
  const Eigen::Vector2d along = directionOf(plane);
  std::vector<WallStretch> stretches;
  for (const PlanarPolygon& polygon : plane.polygons) {
    std::vector<Eigen::Vector3d> crossings;
    addCrossings(z, polygon.outer, crossings);
    for (const auto& hole : polygon.holes) addCrossings(z, hole, crossings);
    std::sort(crossings.begin(), crossings.end(), [&](const auto& a, const auto& b) {
      return along.dot(a.template head<2>()) < along.dot(b.template head<2>());
    });
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      stretches.emplace_back(crossings[i].head<2>(), crossings[i + 1].head<2>());
    }
  }
  return stretches;
}

std::vector<WallStretch> footprintsOf(const PlanarMapPlane& plane) {
  const Eigen::Vector2d along = directionOf(plane);
  const auto before = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return along.dot(a.head<2>()) < along.dot(b.head<2>());
  };
  std::vector<WallStretch> stretches;
  for (const PlanarPolygon& polygon : plane.polygons) {
    const auto [first, last] =
        std::minmax_element(polygon.outer.begin(), polygon.outer.end(), before);
    if (first != polygon.outer.end()) stretches.emplace_back(first->head<2>(), last->head<2>());
  }
  return stretches;
}

}  // namespace opp::mapping
