// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/polygon_overlap.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp::mapping {
namespace {

using Ring = std::vector<Eigen::Vector3d>;
using Ring2 = std::vector<Eigen::Vector2d>;
/// Rings of one polygon; a point is inside if it is inside an odd number of them.
using Polygon2 = std::vector<Ring2>;

/// The grid has at most this many times the wanted points, however little of its box is filled.
constexpr double kMaxGridRatio = 100.0;

double ringArea(const Ring& ring) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < ring.size(); ++k) {
    sum += (ring[k] - ring[0]).cross(ring[(k + 1) % ring.size()] - ring[0]);
  }
  return 0.5 * sum.norm();
}

/// Unit vector of the longest edge: a grid along it fits narrow polygons closely.
Eigen::Vector3d longestEdge(const std::vector<PlanarPolygon>& polygons) {
  Eigen::Vector3d longest = Eigen::Vector3d::Zero();
  for (const PlanarPolygon& polygon : polygons) {
    for (std::size_t k = 0; k < polygon.outer.size(); ++k) {
      const Eigen::Vector3d edge = polygon.outer[(k + 1) % polygon.outer.size()] - polygon.outer[k];
      if (edge.squaredNorm() > longest.squaredNorm()) longest = edge;
    }
  }
  return longest;
}

std::vector<Polygon2> project(const std::vector<PlanarPolygon>& polygons,
                              const Eigen::Matrix<double, 3, 2>& axes) {
  const auto flat = [&](const Ring& ring) {
    Ring2 result;
    for (const Eigen::Vector3d& vertex : ring) result.push_back(axes.transpose() * vertex);
    return result;
  };
  std::vector<Polygon2> result;
  for (const PlanarPolygon& polygon : polygons) {
    result.push_back({flat(polygon.outer)});
    for (const Ring& hole : polygon.holes) result.back().push_back(flat(hole));
  }
  return result;
}

bool inside(const Polygon2& polygon, const Eigen::Vector2d& p) {
  bool odd = false;
  for (const Ring2& ring : polygon) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Eigen::Vector2d& a = ring[k];
      const Eigen::Vector2d& b = ring[(k + 1) % ring.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) odd = !odd;
    }
  }
  return odd;
}

bool insideAny(const std::vector<Polygon2>& polygons, const Eigen::Vector2d& p) {
  return std::any_of(polygons.begin(), polygons.end(),
                     [&](const Polygon2& polygon) { return inside(polygon, p); });
}

double distanceToSegment(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Eigen::Vector3d& point) {
  const Eigen::Vector3d ab = b - a;
  const double s = ab.squaredNorm() > 0.0 ? ab.dot(point - a) / ab.squaredNorm() : 0.0;
  return (point - a - std::clamp(s, 0.0, 1.0) * ab).norm();
}

}  // namespace

double areaOf(const std::vector<PlanarPolygon>& polygons) {
  double area = 0.0;
  for (const PlanarPolygon& polygon : polygons) {
    area += ringArea(polygon.outer);
    for (const Ring& hole : polygon.holes) area -= ringArea(hole);
  }
  return std::max(area, 0.0);
}

double sharedArea(const Plane& plane, const std::vector<PlanarPolygon>& on_plane,
                  const std::vector<PlanarPolygon>& others) {
  const double area = areaOf(on_plane);
  const Eigen::Vector3d edge = longestEdge(on_plane);
  if (!(area > 0.0) || others.empty()) return 0.0;
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = (edge - plane.normal().dot(edge) * plane.normal()).normalized();
  axes.col(1) = plane.normal().cross(axes.col(0));
  const std::vector<Polygon2> a = project(on_plane, axes);
  const std::vector<Polygon2> b = project(others, axes);
  Eigen::AlignedBox2d box;
  for (const Polygon2& polygon : a) {
    for (const Eigen::Vector2d& vertex : polygon.front()) box.extend(vertex);
  }
  const double box_area = box.sizes().prod();
  const double cell = std::sqrt(std::max(area, box_area / kMaxGridRatio) / kOverlapSamples);
  const auto columns = static_cast<int>(std::ceil(box.sizes().x() / cell));
  const auto rows = static_cast<int>(std::ceil(box.sizes().y() / cell));
  // Cells that fill the box exactly, so that a rectangle's own samples add up to its area.
  const Eigen::Vector2d step(box.sizes().x() / columns, box.sizes().y() / rows);
  int shared = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Eigen::Vector2d p =
          box.min() + Eigen::Vector2d((column + 0.5) * step.x(), (row + 0.5) * step.y());
      if (insideAny(a, p) && insideAny(b, p)) ++shared;
    }
  }
  return shared * step.x() * step.y();
}

double distanceTo(const Plane& plane, const std::vector<PlanarPolygon>& on_plane,
                  const Eigen::Vector3d& point) {
  const Eigen::Matrix<double, 3, 2> axes = tangentBasis(plane.normal());
  const Eigen::Vector3d foot = plane.project(point);
  double distance = std::numeric_limits<double>::infinity();
  for (const PlanarPolygon& polygon : on_plane) {
    const PlanarPolygon filled{polygon.outer, {}};
    if (insideAny(project({filled}, axes), axes.transpose() * foot)) return 0.0;
    const Ring& ring = polygon.outer;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      distance = std::min(distance, distanceToSegment(ring[k], ring[(k + 1) % ring.size()], foot));
    }
  }
  return distance;
}

}  // namespace opp::mapping
