// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/plane_kinds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace opp::mapping {
namespace {

/// Key of the family of a plane; planes without family count alone.
int groupOf(const PlanarMapPlane& plane) {
  return plane.family >= 0 ? plane.family : -1 - plane.id;
}

double heightSpan(const PlanarMapPlane& plane, const Eigen::Vector3d& up) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const PlanarPolygon& polygon : plane.polygons) {
    for (const Eigen::Vector3d& vertex : polygon.outer) {
      low = std::min(low, up.dot(vertex));
      high = std::max(high, up.dot(vertex));
    }
  }
  return std::max(0.0, high - low);
}

}  // namespace

std::optional<Eigen::Vector3d> estimateUp(const PlanarMap& map, const Eigen::Vector3d& roughly_up,
                                          const PlanarParams& params) {
  struct Group {
    double area = 0.0;
    double largest = 0.0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  };
  std::map<int, Group> groups;
  for (const PlanarMapPlane& plane : map.planes) {
    const double cosine = plane.plane.normal().dot(roughly_up.normalized());
    if (std::abs(cosine) < std::cos(params.max_camera_tilt)) continue;
    Group& group = groups[groupOf(plane)];
    group.area += plane.area;
    if (plane.area <= group.largest) continue;
    group.largest = plane.area;
    group.direction = cosine > 0.0 ? plane.plane.normal() : Eigen::Vector3d(-plane.plane.normal());
  }
  const auto best =
      std::max_element(groups.begin(), groups.end(),
                       [](const auto& a, const auto& b) { return a.second.area < b.second.area; });
  if (best == groups.end() || best->second.area <= 0.0) return std::nullopt;
  return best->second.direction;
}

void classifyPlanes(PlanarMap& map, const Eigen::Vector3d& up, const PlanarParams& params) {
  const double level = std::cos(params.tilt_tolerance);
  const double plumb = std::sin(params.tilt_tolerance);
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const PlanarMapPlane& plane : map.planes) {
    const double cosine = plane.plane.normal().dot(up);
    if (cosine > level) lowest = std::min(lowest, up.dot(plane.centroid));
    if (cosine < -level) highest = std::max(highest, up.dot(plane.centroid));
  }
  for (PlanarMapPlane& plane : map.planes) {
    const double cosine = plane.plane.normal().dot(up);
    const double height = up.dot(plane.centroid);
    if (cosine > level) {
      const bool is_lowest = height <= lowest + params.outline_tolerance;
      plane.kind = is_lowest ? PlaneKind::kFloor : PlaneKind::kHorizontal;
    } else if (cosine < -level) {
      const bool is_highest = height >= highest - params.outline_tolerance;
      plane.kind = is_highest ? PlaneKind::kCeiling : PlaneKind::kHorizontal;
    } else if (std::abs(cosine) < plumb) {
      const bool is_high = heightSpan(plane, up) >= params.wall_height;
      plane.kind = is_high ? PlaneKind::kWall : PlaneKind::kVertical;
    } else {
      plane.kind = PlaneKind::kOther;
    }
  }
}

}  // namespace opp::mapping
