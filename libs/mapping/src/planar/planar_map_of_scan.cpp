// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/planar_map_of_scan.h"

#include "opp/mapping/planar/build_polygons.h"
#include "opp/mapping/planar/plane_extent.h"
#include "opp/mapping/planar/plane_kinds.h"
#include "opp/mapping/planar/snap_polygons.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// A ray has passed through a plane if it ends this many standard deviations behind it.
constexpr double kBehind = 5.0;

/// Direction of the longest edge of a plane: outlines mostly run along it.
Eigen::Vector3d edgeDirection(const Primitives& primitives, int plane) {
  Eigen::Vector3d longest = Eigen::Vector3d::Zero();
  for (const LineSegment& line : primitives.lines) {
    if (line.planes[0] != plane && line.planes[1] != plane) continue;
    const Eigen::Vector3d along = line.end - line.start;
    if (along.squaredNorm() > longest.squaredNorm()) longest = along;
  }
  if (longest.squaredNorm() > 0.0) return longest;
  for (const OrthogonalityEdge& edge : primitives.edges) {
    if (edge.planes[0] != plane && edge.planes[1] != plane) continue;
    const int other = edge.planes[0] == plane ? edge.planes[1] : edge.planes[0];
    return primitives.planes[static_cast<std::size_t>(other)].plane.normal();
  }
  return Eigen::Vector3d::UnitZ();
}

/// Mean extent of a plane's samples [m]; the cloud's spacing if it has none.
double meanExtent(const OrientedCloud& cloud, const Primitives& primitives, int plane) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (primitives.labels[i] != plane) continue;
    sum += cloud.extent(i);
    count += 1.0;
  }
  return count > 0.0 ? sum / count : cloud.spacing;
}

/// A map's lengths are for places seen from many viewpoints. In one scan what is finer than they
/// are is known as well as samples of extent `extent` [m] show it.
PlanarParams atExtent(const PlanarParams& params, double extent) {
  constexpr double kLeastSamples = 4.0;  // of a polygon
  PlanarParams result = params;
  result.cell = std::min(params.cell, extent);
  result.min_area = std::min(params.min_area, kLeastSamples * extent * extent);
  result.outline_tolerance = std::min(params.outline_tolerance, extent);
  return result;
}

PlaneExtent extentOf(const OrientedCloud& cloud, const Primitives& primitives, int plane,
                     const PlanarParams& params) {
  const PlaneFrame frame(primitives.planes[static_cast<std::size_t>(plane)].plane,
                         edgeDirection(primitives, plane));
  PlaneExtent extent(frame, params.cell);
  const Eigen::Vector3d viewpoint = cloud.viewpoint.cast<double>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d point = cloud.points[i].cast<double>();
    if (primitives.labels[i] == plane) {
      extent.addSupport(point, cloud.extent(i));
    } else {
      extent.addSightline(viewpoint, point, cloud.extent(i),
                          std::max(params.cell, kBehind * cloud.sigmas[i]));
    }
  }
  return extent;
}

PlanarMapPlane planeOf(const OrientedCloud& cloud, const Primitives& primitives, int id,
                       const PlanarParams& params, double timestamp) {
  const PlanePrimitive& primitive = primitives.planes[static_cast<std::size_t>(id)];
  PlanarMapPlane plane;
  plane.id = id;
  plane.plane = primitive.plane;
  plane.rms = primitive.rms;
  plane.family = primitive.family;
  plane.covariance = primitive.covariance;
  plane.observations = {timestamp};
  double points = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (primitives.labels[i] == id) points += static_cast<double>(cloud.weights[i]);
  }
  plane.points = std::lround(points);
  const PlanarParams fine = atExtent(params, meanExtent(cloud, primitives, id));
  plane.polygons = buildPolygons(extentOf(cloud, primitives, id, fine), fine);
  plane.area = areaOf(plane.polygons, plane.plane.normal());
  plane.centroid = plane.polygons.empty() ? plane.plane.project(primitive.moments.mean())
                                          : centroidOf(plane.polygons, plane.plane.normal());
  return plane;
}

}  // namespace

PlanarMap planarMapOfScan(const OrientedCloud& cloud, const Primitives& primitives,
                          const PlanarParams& params, double timestamp,
                          const std::optional<Eigen::Vector3d>& up) {
  validate(params);
  if (primitives.labels.size() != cloud.size()) {
    throw std::invalid_argument(
        "planarMapOfScan: one label for each sample of the cloud is needed");
  }
  PlanarMap map;
  map.frame = "sensor";
  for (int id = 0; id < static_cast<int>(primitives.planes.size()); ++id) {
    map.planes.push_back(planeOf(cloud, primitives, id, params, timestamp));
  }
  for (const OrthogonalityEdge& edge : primitives.edges) {
    map.planes[static_cast<std::size_t>(edge.planes[0])].orthogonal_to.push_back(edge.planes[1]);
    map.planes[static_cast<std::size_t>(edge.planes[1])].orthogonal_to.push_back(edge.planes[0]);
  }
  for (PlanarMapPlane& plane : map.planes) {
    std::sort(plane.orthogonal_to.begin(), plane.orthogonal_to.end());
  }
  for (const ParallelFamily& family : primitives.families) {
    map.families.push_back({static_cast<int>(map.families.size()), family.normal, family.planes});
  }
  for (const LineSegment& line : primitives.lines) {
    map.lines.push_back(
        {static_cast<int>(map.lines.size()), line.planes, line.start, line.end, line.kind});
  }
  for (const Corner& corner : primitives.corners) {
    map.corners.push_back({static_cast<int>(map.corners.size()),
                           corner.planes,
                           corner.position,
                           Eigen::Quaterniond(corner.cloud_from_corner).normalized(),
                           corner.kind,
                           corner.covariance,
                           {timestamp}});
  }
  snapPolygons(map, params);
  if (up) {
    classifyPlanes(map, *up, params);
    for (PlanarMapPlane& plane : map.planes) {
      if (plane.kind == PlaneKind::kFloor || plane.kind == PlaneKind::kCeiling) {
        plane.kind = PlaneKind::kHorizontal;
      } else if (plane.kind == PlaneKind::kWall) {
        plane.kind = PlaneKind::kVertical;
      }
    }
  }
  return map;
}

}  // namespace opp::mapping
