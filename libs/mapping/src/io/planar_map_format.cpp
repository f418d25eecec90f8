// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/atomic_file.h"
#include "opp/mapping/io/planar_map_json.h"

#include "io/planar_map_names.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <ostream>
#include <stdexcept>

namespace opp::mapping {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  if (!std::isfinite(value)) {
    throw std::invalid_argument("a planar map holds a number that is not finite");
  }
  return value;
}

template <typename Vector>
Json vectorJson(const Vector& vector) {
  Json json = Json::array();
  for (const double value : vector) json.push_back(number(value));
  return json;
}

Json matrixJson(const Eigen::Matrix3d& matrix) {
  Json json = Json::array();
  for (int row = 0; row < 3; ++row) json.push_back(vectorJson(matrix.row(row)));
  return json;
}

Json ringJson(const std::vector<Eigen::Vector3d>& ring) {
  Json json = Json::array();
  for (const Eigen::Vector3d& vertex : ring) json.push_back(vectorJson(vertex));
  return json;
}

Json toJson(const PlanarPolygon& polygon) {
  Json holes = Json::array();
  for (const auto& hole : polygon.holes) holes.push_back(ringJson(hole));
  return {{"outer", ringJson(polygon.outer)}, {"holes", std::move(holes)}};
}

Json toJson(const PlanarMapPlane& plane) {
  Json polygons = Json::array();
  for (const PlanarPolygon& polygon : plane.polygons) polygons.push_back(toJson(polygon));
  return {{"id", plane.id},
          {"normal", vectorJson(plane.plane.normal())},
          {"d", number(plane.plane.d())},
          {"centroid", vectorJson(plane.centroid)},
          {"area", number(plane.area)},
          {"points", plane.points},
          {"rms", number(plane.rms)},
          {"family", plane.family < 0 ? Json() : Json(plane.family)},
          {"kind", wordOf(kPlaneKinds, plane.kind)},
          {"polygons", std::move(polygons)},
          {"orthogonal_to", plane.orthogonal_to},
          {"covariance", matrixJson(plane.covariance)},
          {"observations", vectorJson(plane.observations)}};
}

Json toJson(const PlanarMapFamily& family) {
  return {{"id", family.id}, {"normal", vectorJson(family.normal)}, {"planes", family.planes}};
}

Json toJson(const PlanarMapLine& line) {
  return {{"id", line.id},
          {"planes", line.planes},
          {"start", vectorJson(line.start)},
          {"end", vectorJson(line.end)},
          {"kind", wordOf(kLineKinds, line.kind)}};
}

Json toJson(const PlanarMapCorner& corner) {
  return {{"id", corner.id},
          {"planes", corner.planes},
          {"position", vectorJson(corner.position)},
          {"orientation", vectorJson(corner.orientation.coeffs())},  // x, y, z, w
          {"kind", wordOf(kCornerKinds, corner.kind)},
          {"covariance", matrixJson(corner.covariance)},
          {"observations", vectorJson(corner.observations)}};
}

/// Appends a list with one element a line: readable, and short in a diff.
template <typename Elements>
void appendList(std::string& text, const char* key, const Elements& elements) {
  if (text.back() != '{') text += ",\n";
  text += std::string("\"") + key + "\": [";
  bool first = true;
  for (const auto& element : elements) {
    text += (first ? "\n  " : ",\n  ") + toJson(element).dump();
    first = false;
  }
  text += first ? "]" : "\n]";
}

}  // namespace

std::string formatPlanarMap(const PlanarMap& map, const DetectionSummary* detection) {
  std::string text =
      "{\"format\": \"opp-planar-map\", \"version\": 1, \"frame\": " + Json(map.frame).dump() +
      ", \"unit\": \"m\"";
  if (detection != nullptr) {
    Json timings = Json::object();
    for (const auto& [stage, milliseconds] : detection->timings_ms) {
      timings[stage] = number(milliseconds);
    }
    text += ",\n\"timings_ms\": " + timings.dump() +
            ", \"points\": " + std::to_string(detection->points);
  }
  appendList(text, "planes", map.planes);
  appendList(text, "families", map.families);
  appendList(text, "lines", map.lines);
  appendList(text, "corners", map.corners);
  if (!map.barely_seen.empty()) {
    text += ",\n\"barely_seen\": {";
    appendList(text, "planes", map.barely_seen.planes);
    appendList(text, "lines", map.barely_seen.lines);
    appendList(text, "corners", map.barely_seen.corners);
    text += "}";
  }
  return text + "\n}\n";
}

void writePlanarMap(const std::filesystem::path& path, const PlanarMap& map,
                    const DetectionSummary* detection) {
  const std::string text = formatPlanarMap(map, detection);
  writeFileAtomically(path, [&](std::ostream& stream) { stream << text; });
}

}  // namespace opp::mapping
