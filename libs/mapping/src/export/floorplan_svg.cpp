// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/floorplan_svg.h"

#include "opp/mapping/core/move_planar_map.h"
#include "opp/mapping/io/atomic_file.h"
#include "opp/mapping/planar/level_frame.h"

#include "export/drawing_numbers.h"
#include "export/wall_cut.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

namespace opp::mapping {
namespace {

constexpr double kUnitsPerMetre = 100.0;
constexpr double kCutHeight = 1.2;  ///< [m] above the floor: architects' habit, cuts most windows
constexpr double kMargin = 0.5;     ///< [m] around the plan
constexpr double kBarRoom = 0.6;    ///< [m] for the scale bar below it

/// Collects the drawing in units of the page: x to the right, y down.
class Drawing {
 public:
  explicit Drawing(const Eigen::AlignedBox2d& bounds) : bounds_(bounds) {}

  std::string at(const Eigen::Vector2d& point) const {
    return svgNumber(kUnitsPerMetre * (point.x() - bounds_.min().x())) + ' ' +
           svgNumber(kUnitsPerMetre * (bounds_.max().y() - point.y()));
  }

  void polygons(const PlanarMapPlane& plane, const std::string& style) {
    std::string path;
    for (const PlanarPolygon& polygon : plane.polygons) {
      addRing(polygon.outer, path);
      for (const auto& hole : polygon.holes) addRing(hole, path);
    }
    if (!path.empty()) body_ += "<path " + style + " fill-rule=\"evenodd\" d=\"" + path + "\"/>\n";
  }

  void stretches(const std::vector<WallStretch>& stretches, const std::string& style) {
    std::string path;
    for (const auto& [from, to] : stretches) path += "M" + at(from) + "L" + at(to);
    if (!path.empty()) body_ += "<path " + style + " d=\"" + path + "\"/>\n";
  }

  void way(const Trajectory& trajectory, const Eigen::Isometry3d& level_from_map,
           const std::string& style) {
    std::string path;
    for (const StampedPose& pose : trajectory) {
      const Eigen::Vector3d position = level_from_map * pose.map_from_body.translation();
      path += (path.empty() ? "M" : "L") + at(position.head<2>());
    }
    if (!path.empty()) body_ += "<path " + style + " d=\"" + path + "\"/>\n";
  }

  /// A bar of 1, 2 or 5 times a power of ten metres, about a quarter of the page.
  void scaleBar() {
    const double length = roundStep(0.25 * bounds_.sizes().x());
    const Eigen::Vector2d left = bounds_.min() + Eigen::Vector2d(kMargin, 0.4 * kBarRoom);
    const Eigen::Vector2d right = left + Eigen::Vector2d(length, 0.0);
    const Eigen::Vector2d tick(0.0, 0.1);
    body_ += "<path class=\"bar\" d=\"M" + at(left + tick) + "L" + at(left) + "L" + at(right) +
             "L" + at(right + tick) + "\"/>\n";
    std::string place = at(right + Eigen::Vector2d(0.15, 0.0));
    place.replace(place.find(' '), 1, "\" y=\"");
    const bool in_metres = length >= 1.0;
    body_ += "<text x=\"" + place + "\">" + svgNumber(in_metres ? length : 100.0 * length) +
             (in_metres ? " m" : " cm") + "</text>\n";
  }

  std::string svg() const {
    const std::string width = svgNumber(kUnitsPerMetre * bounds_.sizes().x());
    const std::string height = svgNumber(kUnitsPerMetre * bounds_.sizes().y());
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + width + ' ' + height +
           "\" width=\"" + width + "\" height=\"" + height +
           "\">\n<style>path{fill:none;stroke-linecap:round;stroke-linejoin:round}"
           ".floor{fill:#ece7dd}.top{fill:#dcd6c8;stroke:#b9b09c;stroke-width:1}"
           ".low{stroke:#9a9a9a;stroke-width:2}.wall{stroke:#222;stroke-width:7}"
           ".way{stroke:#c0392b;stroke-width:2}.bar{stroke:#222;stroke-width:2}"
           "text{font:20px sans-serif;fill:#222}</style>\n"
           "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
           body_ + "</svg>\n";
  }

 private:
  void addRing(const std::vector<Eigen::Vector3d>& ring, std::string& path) const {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      path += (i == 0 ? "M" : "L") + at(ring[i].head<2>());
    }
    path += 'Z';
  }

  Eigen::AlignedBox2d bounds_;
  std::string body_;
};

Eigen::AlignedBox2d boundsOf(const PlanarMap& level_map, const Trajectory& trajectory,
                             const Eigen::Isometry3d& level_from_map) {
  Eigen::AlignedBox2d bounds;
  for (const PlanarMapPlane& plane : level_map.planes) {
    for (const PlanarPolygon& polygon : plane.polygons) {
      for (const Eigen::Vector3d& vertex : polygon.outer) bounds.extend(vertex.head<2>());
    }
  }
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d position = level_from_map * pose.map_from_body.translation();
    bounds.extend(position.head<2>());
  }
  if (bounds.isEmpty()) bounds = Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1));
  bounds.min() -= Eigen::Vector2d(kMargin, kMargin + kBarRoom);
  bounds.max() += Eigen::Vector2d(kMargin, kMargin);
  return bounds;
}

bool isPlumb(const PlanarMapPlane& plane) {
  return plane.kind == PlaneKind::kWall || plane.kind == PlaneKind::kVertical;
}

/// Height of the lowest floor, else of the lowest vertex.
double floorHeight(const PlanarMap& level_map) {
  double floor = std::numeric_limits<double>::infinity(), lowest = floor;
  for (const PlanarMapPlane& plane : level_map.planes) {
    if (plane.kind == PlaneKind::kFloor) floor = std::min(floor, plane.centroid.z());
    for (const PlanarPolygon& polygon : plane.polygons) {
      for (const Eigen::Vector3d& vertex : polygon.outer) lowest = std::min(lowest, vertex.z());
    }
  }
  return std::isfinite(floor) ? floor : lowest;
}

}  // namespace

std::string floorplanSvg(const PlanarMap& map, const Trajectory& trajectory,
                         const Eigen::Vector3d& up) {
  const Eigen::Isometry3d level_from_map = levelFromMap(map, up);
  const PlanarMap level_map = movedPlanarMap(level_from_map, map);
  Drawing drawing(boundsOf(level_map, trajectory, level_from_map));
  for (const PlanarMapPlane& plane : level_map.planes) {
    if (plane.kind == PlaneKind::kFloor) drawing.polygons(plane, "class=\"floor\"");
  }
  for (const PlanarMapPlane& plane : level_map.planes) {
    const bool is_top = plane.kind == PlaneKind::kHorizontal && plane.plane.normal().z() > 0.0;
    if (is_top) drawing.polygons(plane, "class=\"top\"");
  }
  const double cut = floorHeight(level_map) + kCutHeight;
  for (const PlanarMapPlane& plane : level_map.planes) {
    if (isPlumb(plane)) drawing.stretches(footprintsOf(plane), "class=\"low\"");
  }
  for (const PlanarMapPlane& plane : level_map.planes) {
    if (isPlumb(plane)) drawing.stretches(cutAt(cut, plane), "class=\"wall\"");
  }
  drawing.way(trajectory, level_from_map, "class=\"way\"");
  drawing.scaleBar();
  return drawing.svg();
}

void writeFloorplan(const std::filesystem::path& path, const PlanarMap& map,
                    const Trajectory& trajectory, const Eigen::Vector3d& up) {
  const std::string svg = floorplanSvg(map, trajectory, up);
  writeFileAtomically(path, [&](std::ostream& stream) { stream << svg; });
}

}  // namespace opp::mapping
