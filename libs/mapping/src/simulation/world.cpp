// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/world.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace opp::mapping {
namespace {

using Ring = std::vector<Eigen::Vector3d>;

/// Twice the area times the normal (Newell's method, about the first vertex to keep digits).
Eigen::Vector3d doubledAreaVector(const Ring& ring) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    sum += (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]);
  }
  return sum;
}

double extent(const Ring& ring) {
  double longest = 0.0;
  for (const auto& vertex : ring) longest = std::max(longest, (vertex - ring[0]).norm());
  return longest;
}

void requireFlat(const Ring& ring, const Plane& plane, double tolerance) {
  for (const auto& vertex : ring) {
    if (!(std::abs(plane.signedDistance(vertex)) <= tolerance)) {
      throw std::invalid_argument("face of the world: its vertices are not in one plane");
    }
  }
}

}  // namespace

void World::addFace(Ring outer, std::vector<Ring> holes, bool curved) {
  if (outer.size() < 3) throw std::invalid_argument("face of the world: fewer than 3 vertices");
  const Eigen::Vector3d normal = doubledAreaVector(outer);
  const double size = extent(outer);
  if (!normal.allFinite() || !(normal.norm() > 1e-12 * size * size)) {
    throw std::invalid_argument("face of the world: it has no area or is not finite");
  }
  const Plane plane = Plane::fromPointNormal(outer[0], normal);
  requireFlat(outer, plane, 1e-9 * size);
  for (const Ring& hole : holes) {
    if (hole.size() < 3) throw std::invalid_argument("face of the world: hole of < 3 vertices");
    requireFlat(hole, plane, 1e-9 * size);
  }
  faces_.push_back({std::move(outer), std::move(holes), plane, curved});
}

Plane World::sidePlane(int side) const {
  const Plane& front = faces_.at(static_cast<std::size_t>(side / 2)).plane;
  return side % 2 == 0 ? front : front.flipped();
}

}  // namespace opp::mapping
