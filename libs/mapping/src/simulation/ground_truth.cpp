// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/ground_truth.h"

#include "seen_plane.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace opp::mapping {

struct GroundTruth::Impl {
  const World& world;
  GroundTruthParams params;
  SeenSides sides;
  std::map<int, std::vector<double>> observations;  ///< timestamps, by side

  void addPixel(int side, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);
  /// Times of the frames that saw enough of a side of the plane, ascending.
  std::vector<double> observationsOf(const SeenPlane& plane) const;
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

/// Adds segments with ids that go on from `first_id`.
void addSegments(const std::vector<SeenLine>& segments, int first_id,
                 std::vector<PlanarMapLine>& lines) {
  for (const SeenLine& line : segments) {
    lines.push_back({first_id++, line.planes, line.start, line.end, line.kind});
  }
}

/// Numbers corners from `first_id` on.
std::vector<PlanarMapCorner> numbered(std::vector<PlanarMapCorner> corners, int first_id) {
  for (PlanarMapCorner& corner : corners) corner.id = first_id++;
  return corners;
}

void setPartners(PlanarMap& map) {
  for (const PlanarMapLine& line : map.lines) {
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
    params.near_gap = 0.1;
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

std::vector<double> GroundTruth::Impl::observationsOf(const SeenPlane& plane) const {
  std::set<double> times;
  for (const int side : plane.sides) {
    const auto found = observations.find(side);
    if (found != observations.end()) times.insert(found->second.begin(), found->second.end());
  }
  return {times.begin(), times.end()};
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
  for (std::size_t i = 0; i < seen.size(); ++i) {
    PlanarMapPlane entry;
    entry.id = static_cast<int>(i);
    entry.plane = seen[i].plane;
    entry.points = static_cast<long>(seen[i].pixels);
    entry.kind = kindOf(seen[i], box);
    entry.centroid = seen[i].someSeenPoint();
    setPolygons(seen[i], seenPolygons(geos, seen[i], params), entry);
    entry.observations = impl_->observationsOf(seen[i]);
    auto& list = isBarelySeen(seen[i], params) ? map.barely_seen.planes : map.planes;
    list.push_back(std::move(entry));
  }
  addFamilies(map);
  const std::vector<SeenLine> lines = seenLines(seen, seams(geos, seen, kTouch), params);
  const std::vector<Seam> near_seams = seams(geos, seen, std::max(kTouch, params.near_gap));
  addSegments(lines, 0, map.lines);
  setPartners(map);
  addSegments(restOfSeams(near_seams, lines, params), static_cast<int>(lines.size()),
              map.barely_seen.lines);
  SeenCorners corners = seenCorners(geos, seen, near_seams, lines, params);
  map.corners = numbered(std::move(corners.corners), 0);
  map.barely_seen.corners =
      numbered(std::move(corners.barely), static_cast<int>(map.corners.size()));
  return map;
}

}  // namespace opp::mapping
