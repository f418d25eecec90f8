// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/ground_truth.h"

#include "seen_plane.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace opp::mapping {

struct GroundTruth::Impl {
  const World& world;
  GroundTruthParams params;
  SeenSides sides;
  std::map<int, std::vector<double>> observations;  ///< timestamps, by side

  void addPixel(int side, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);
};

namespace {

PlaneKind kindOf(const SeenPlane& seen, const Eigen::AlignedBox3d& world) {
  constexpr double kLevel = 1e-6;
  const double up = seen.plane.normal().z();
  if (std::abs(up) < kLevel) {
    // A wall reaches from floor to ceiling, or nearly so; furniture does not.
    const bool tall = seen.box.sizes().z() > 0.9 * world.sizes().z();
    return tall ? PlaneKind::kWall : PlaneKind::kVertical;
  }
  if (up > 1.0 - kLevel) {
    const bool lowest = seen.box.min().z() < world.min().z() + kLevel;
    return lowest ? PlaneKind::kFloor : PlaneKind::kHorizontal;
  }
  if (up < -1.0 + kLevel) {
    const bool highest = seen.box.max().z() > world.max().z() - kLevel;
    return highest ? PlaneKind::kCeiling : PlaneKind::kHorizontal;
  }
  return PlaneKind::kOther;
}

std::vector<Eigen::Vector3d> lifted(const PlaneCoordinates& coordinates, const Ring2d& ring) {
  std::vector<Eigen::Vector3d> result;
  for (const auto& uv : ring) result.push_back(coordinates.point(uv));
  return result;
}

/// Area, and first moments, of a ring: positive if it runs counter-clockwise.
void addRing(const Ring2d& ring, double& area, Eigen::Vector2d& moment) {
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
    const double part = 0.5 * (a.x() * b.y() - a.y() * b.x());
    area += part;
    moment += part * (ring[0] + ring[i] + ring[i + 1]) / 3.0;
  }
}

void setPolygons(const SeenPlane& seen, const std::vector<Polygon2d>& polygons,
                 PlanarMapPlane& plane) {
  const PlaneCoordinates coordinates = seen.coordinates();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (const Polygon2d& polygon : polygons) {
    PlanarPolygon lifted_polygon{lifted(coordinates, polygon.outer), {}};
    addRing(polygon.outer, plane.area, moment);
    for (const Ring2d& hole : polygon.holes) {
      lifted_polygon.holes.push_back(lifted(coordinates, hole));
      addRing(hole, plane.area, moment);
    }
    plane.polygons.push_back(std::move(lifted_polygon));
  }
  if (plane.area > 0.0) plane.centroid = coordinates.point(moment / plane.area);
}

void addFamilies(PlanarMap& map) {
  constexpr double kParallel = 1e-7;
  for (PlanarMapPlane& plane : map.planes) {
    const Eigen::Vector3d& normal = plane.plane.normal();
    auto family = std::find_if(map.families.begin(), map.families.end(), [&](const auto& other) {
      return normal.cross(other.normal).norm() < kParallel;
    });
    if (family == map.families.end()) {
      map.families.push_back({static_cast<int>(map.families.size()), normal, {}});
      family = map.families.end() - 1;
    }
    family->planes.push_back(plane.id);
    plane.family = family->id;
  }
}

void addLines(const std::vector<SeenLine>& lines, PlanarMap& map) {
  for (const SeenLine& line : lines) {
    map.lines.push_back(
        {static_cast<int>(map.lines.size()), line.planes, line.start, line.end, line.kind});
    for (std::size_t end = 0; end < 2; ++end) {
      auto& partners = map.planes[static_cast<std::size_t>(line.planes[end])].orthogonal_to;
      partners.push_back(line.planes[1 - end]);
    }
  }
  for (PlanarMapPlane& plane : map.planes) {
    auto& partners = plane.orthogonal_to;
    std::sort(partners.begin(), partners.end());
    partners.erase(std::unique(partners.begin(), partners.end()), partners.end());
  }
}

}  // namespace

GroundTruthParams GroundTruthParams::forSensor(SimulatedSensor sensor) {
  GroundTruthParams params;
  if (sensor == SimulatedSensor::kLidar16 || sensor == SimulatedSensor::kLidar64) {
    params.cell = 0.1;
    params.closing = 0.3;
    params.reach = 0.3;
  }
  return params;
}

GroundTruth::GroundTruth(const World& world, const GroundTruthParams& params) {
  validate(params);
  impl_ = std::make_unique<Impl>(Impl{world, params, {}, {}});
}
GroundTruth::~GroundTruth() = default;
GroundTruth::GroundTruth(GroundTruth&&) noexcept = default;
GroundTruth& GroundTruth::operator=(GroundTruth&&) noexcept = default;

void GroundTruth::Impl::addPixel(int side, const Eigen::Vector3d& origin,
                                 const Eigen::Vector3d& direction) {
  const Plane plane = world.sidePlane(side);
  const double distance = -plane.signedDistance(origin) / plane.normal().dot(direction);
  auto found = sides.find(side);
  if (found == sides.end()) {
    const Face& face = world.faces()[static_cast<std::size_t>(side / 2)];
    found = sides.emplace(side, Coverage(face, plane, params.cell)).first;
  }
  found->second.add(origin + distance * direction);
}

void GroundTruth::add(const SimulatedFrame& frame, const Eigen::Isometry3d& body_from_sensor) {
  const Eigen::Isometry3d map_from_sensor = frame.map_from_body * body_from_sensor;
  std::map<int, long> pixels;
  const auto see = [&](int side, const Eigen::Vector3d& direction_in_sensor) {
    if (side < 0 || impl_->world.faces()[static_cast<std::size_t>(side / 2)].curved) return;
    ++pixels[side];
    impl_->addPixel(side, map_from_sensor.translation(),
                    map_from_sensor.linear() * direction_in_sensor);
  };
  if (const auto* image = std::get_if<DepthImage>(&frame.data)) {
    for (int row = 0; row < image->camera.height; ++row) {
      for (int column = 0; column < image->camera.width; ++column) {
        see(image->sides[image->index(column, row)], image->camera.direction(column, row));
      }
    }
  } else {
    const auto& scan = std::get<LidarScan>(frame.data);
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      see(scan.sides[i], scan.points[i].cast<double>());
    }
  }
  for (const auto& [side, count] : pixels) {
    if (count >= impl_->params.min_pixels) {
      impl_->observations[side].push_back(frame.timestamp);
    }
  }
}

PlanarMap GroundTruth::map() const {
  const Geos geos;
  const auto& params = impl_->params;
  const std::vector<SeenPlane> seen = seenPlanes(geos, impl_->world, impl_->sides, params);
  Eigen::AlignedBox3d box;
  for (const Face& face : impl_->world.faces()) {
    for (const auto& vertex : face.outer) box.extend(vertex);
  }
  PlanarMap map;
  for (const SeenPlane& plane : seen) {
    PlanarMapPlane entry;
    entry.id = static_cast<int>(map.planes.size());
    entry.plane = plane.plane;
    entry.points = static_cast<long>(plane.pixels);
    entry.kind = kindOf(plane, box);
    setPolygons(plane, seenPolygons(geos, plane, params), entry);
    for (const int side : plane.sides) {
      const auto found = impl_->observations.find(side);
      if (found == impl_->observations.end()) continue;
      entry.observations.insert(entry.observations.end(), found->second.begin(),
                                found->second.end());
    }
    std::sort(entry.observations.begin(), entry.observations.end());
    entry.observations.erase(std::unique(entry.observations.begin(), entry.observations.end()),
                             entry.observations.end());
    map.planes.push_back(std::move(entry));
  }
  addFamilies(map);
  const std::vector<Seam> all_seams = seams(geos, seen);
  const std::vector<SeenLine> lines = seenLines(seen, all_seams, params);
  addLines(lines, map);
  map.corners = seenCorners(geos, seen, all_seams, lines, params);
  return map;
}

}  // namespace opp::mapping
