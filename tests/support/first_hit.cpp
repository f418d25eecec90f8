// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/first_hit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace opp::test {
namespace {

using Ring = std::vector<Eigen::Vector3d>;

/// Winding angle of a ring about a point of its plane: ±2π inside, 0 outside.
double windingAngle(const Ring& ring, const Eigen::Vector3d& normal, const Eigen::Vector3d& point) {
  double angle = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector3d a = ring[i] - point, b = ring[(i + 1) % ring.size()] - point;
    angle += std::atan2(normal.dot(a.cross(b)), a.dot(b));
  }
  return angle;
}

double distanceToRing(const Ring& ring, const Eigen::Vector3d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector3d edge = ring[(i + 1) % ring.size()] - ring[i];
    const double s = std::clamp(edge.dot(point - ring[i]) / edge.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (ring[i] + s * edge - point).norm());
  }
  return least;
}

}  // namespace

double firstHit(const mapping::World& world, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction, double& nearest_edge) {
  double first = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, double>> edges;  // distance along the ray, from the outline
  for (const mapping::Face& face : world.faces()) {
    const double t = -face.plane.signedDistance(origin) / face.plane.normal().dot(direction);
    if (!(t > 0.0) || !std::isfinite(t)) continue;
    const Eigen::Vector3d point = origin + t * direction;
    double edge = distanceToRing(face.outer, point);
    bool inside = std::abs(windingAngle(face.outer, face.plane.normal(), point)) > 3.0;
    for (const Ring& hole : face.holes) {
      edge = std::min(edge, distanceToRing(hole, point));
      if (std::abs(windingAngle(hole, face.plane.normal(), point)) > 3.0) inside = false;
    }
    edges.emplace_back(t, edge);
    if (inside) first = std::min(first, t);
  }
  nearest_edge = std::numeric_limits<double>::infinity();
  for (const auto& [t, edge] : edges) {
    if (t <= first + 1e-3) nearest_edge = std::min(nearest_edge, edge);
  }
  return first;
}

}  // namespace opp::test
