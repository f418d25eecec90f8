// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/snap_polygons.h"

#include "opp/mapping/planar/build_polygons.h"
#include "opp/mapping/planar/plane_extent.h"

#include "planar/geos.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace opp::mapping {
namespace {

/// Vertices on a straight edge are dropped: far above rounding, far below what shows.
constexpr double kStraight = 1e-6;
/// Outlines move by at most this share of a polygon's width.
constexpr double kSnapShare = 0.4;
/// Parts that a polygon falls into are kept from this share of it on.
constexpr double kKeptShare = 0.5;

/// What the outlines on one plane snap to, in the plane's coordinates.
struct Targets {
  std::vector<Eigen::Vector2d> corners;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> lines;
  bool empty() const { return corners.empty() && lines.empty(); }
};

Targets targetsOn(const PlanarMapPlane& plane, const PlaneFrame& frame, const PlanarMap& map) {
  const auto is_of_plane = [&](const auto& element) {
    return std::find(element.planes.begin(), element.planes.end(), plane.id) !=
           element.planes.end();
  };
  Targets targets;
  for (const PlanarMapCorner& corner : map.corners) {
    if (is_of_plane(corner)) targets.corners.push_back(frame.project(corner.position));
  }
  for (const PlanarMapLine& line : map.lines) {
    if (is_of_plane(line)) {
      targets.lines.emplace_back(frame.project(line.start), frame.project(line.end));
    }
  }
  return targets;
}

/// The nearest point of a segment to `point`.
Eigen::Vector2d nearestOn(const Eigen::Vector2d& start, const Eigen::Vector2d& end,
                          const Eigen::Vector2d& point) {
  const Eigen::Vector2d along = end - start;
  const double squared = along.squaredNorm();
  const double part = squared > 0.0 ? (point - start).dot(along) / squared : 0.0;
  return start + std::clamp(part, 0.0, 1.0) * along;
}

/// A corner goes before a line, what is near before what is far.
Eigen::Vector2d snapped(const Eigen::Vector2d& vertex, const Targets& targets, double reach) {
  Eigen::Vector2d best = vertex;
  double distance = reach;
  const auto consider = [&](const Eigen::Vector2d& candidate) {
    if ((candidate - vertex).norm() > distance) return;
    distance = (candidate - vertex).norm();
    best = candidate;
  };
  for (const Eigen::Vector2d& corner : targets.corners) consider(corner);
  if (best != vertex) return best;
  for (const auto& [start, end] : targets.lines) consider(nearestOn(start, end, vertex));
  return best;
}

/// Nothing if snapping has moved holes and outline through each other in a way that GEOS cannot
/// untie.
std::vector<Polygon2d> partsOf(const Polygon2d& polygon, double min_area, const Geos& geos) {
  Geos::Geometry shape = geos.collection({});
  try {
    shape = geos.untied(geos.polygon(polygon));
  } catch (const std::runtime_error&) {
    return {};
  }
  std::vector<Polygon2d> parts = geos.polygonsOf(geos.simplify(shape, kStraight));
  const auto is_small = [&](const Ring2d& ring) { return std::abs(signedArea(ring)) < min_area; };
  for (Polygon2d& part : parts) {
    part.holes.erase(std::remove_if(part.holes.begin(), part.holes.end(), is_small),
                     part.holes.end());
  }
  parts.erase(std::remove_if(parts.begin(), parts.end(),
                             [&](const Polygon2d& part) { return is_small(part.outer); }),
              parts.end());
  return parts;
}

/// Mean width of what a ring encloses [m]: a strip's own, half of a square's.
double widthOf(const std::vector<Eigen::Vector3d>& ring, const Eigen::Vector3d& normal) {
  double perimeter = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    perimeter += (ring[(k + 1) % ring.size()] - ring[k]).norm();
  }
  return perimeter > 0.0 ? 2.0 * areaOf({{ring, {}}}, normal) / perimeter : 0.0;
}

Ring2d snappedRing(const std::vector<Eigen::Vector3d>& ring, const PlaneFrame& frame,
                   const Targets& targets, double reach) {
  Ring2d result;
  for (const Eigen::Vector3d& vertex : ring) {
    result.push_back(snapped(frame.project(vertex), targets, reach));
  }
  return result;
}

std::vector<Eigen::Vector3d> lifted(const Ring2d& ring, const PlaneFrame& frame) {
  std::vector<Eigen::Vector3d> vertices;
  for (const Eigen::Vector2d& vertex : ring) vertices.push_back(frame.lift(vertex));
  return vertices;
}

/// A polygon with its vertices moved to the targets, in the parts that this leaves; as it was if it
/// leaves none.
std::vector<PlanarPolygon> snappedPolygon(const PlanarPolygon& polygon, const PlaneFrame& frame,
                                          const Targets& targets, const PlanarParams& params,
                                          const Geos& geos) {
  const Eigen::Vector3d& normal = frame.plane().normal();
  // A strip must not be flattened to a line.
  const double reach = std::min(params.snap, kSnapShare * widthOf(polygon.outer, normal));
  Polygon2d flat{snappedRing(polygon.outer, frame, targets, reach), {}};
  for (const auto& hole : polygon.holes) {
    flat.holes.push_back(snappedRing(hole, frame, targets, reach));
  }
  const double min_area = std::min(params.min_area, kKeptShare * areaOf({polygon}, normal));
  std::vector<PlanarPolygon> result;
  for (const Polygon2d& part : partsOf(flat, min_area, geos)) {
    result.push_back({lifted(part.outer, frame), {}});
    for (const Ring2d& hole : part.holes) result.back().holes.push_back(lifted(hole, frame));
  }
  if (result.empty()) result.push_back(polygon);
  return result;
}

}  // namespace

void snapPolygons(PlanarMap& map, const PlanarParams& params) {
  const Geos geos;
  for (PlanarMapPlane& plane : map.planes) {
    const PlaneFrame frame(plane.plane, Eigen::Vector3d::UnitX());
    const Targets targets = targetsOn(plane, frame, map);
    if (targets.empty() || plane.polygons.empty()) continue;
    std::vector<PlanarPolygon> polygons;
    for (const PlanarPolygon& polygon : plane.polygons) {
      for (PlanarPolygon& part : snappedPolygon(polygon, frame, targets, params, geos)) {
        polygons.push_back(std::move(part));
      }
    }
    plane.polygons = std::move(polygons);
    plane.area = areaOf(plane.polygons, plane.plane.normal());
    plane.centroid = centroidOf(plane.polygons, plane.plane.normal());
  }
}

}  // namespace opp::mapping
