// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/planar_map_json.h"

#include "io/planar_map_names.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

namespace opp::mapping {
namespace {

using Json = nlohmann::json;

/// Largest deviation of a written unit vector from length one: far above rounding, far below what
/// matters.
constexpr double kUnitTolerance = 1e-6;

/// A value in the document together with its path, for error messages.
class Node {
 public:
  Node(const Json& json, std::string path) : json_(json), path_(std::move(path)) {}

  [[noreturn]] void fail(const std::string& problem) const {
    throw std::runtime_error(path_ + ": " + problem);
  }

  bool has(const char* key) const { return json_.is_object() && json_.contains(key); }

  Node operator[](const char* key) const {
    const auto found = json_.is_object() ? json_.find(key) : json_.end();
    if (found == json_.end()) fail(std::string("key \"") + key + "\" is missing");
    return Node(*found, path_ + "." + key);
  }

  std::vector<Node> elements() const {
    if (!json_.is_array()) fail("must be a list");
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < json_.size(); ++i) {
      nodes.emplace_back(json_[i], path_ + "[" + std::to_string(i) + "]");
    }
    return nodes;
  }

  std::vector<Node> elements(std::size_t count) const {
    std::vector<Node> nodes = elements();
    if (nodes.size() != count) fail("must have " + std::to_string(count) + " elements");
    return nodes;
  }

  bool isNull() const { return json_.is_null(); }

  double number() const {
    if (!json_.is_number()) fail("must be a number");
    return json_.get<double>();
  }

  template <typename Integer = int>
  Integer integer() const {
    if (!json_.is_number_integer()) fail("must be a whole number");
    return json_.get<Integer>();
  }

  std::string text() const {
    if (!json_.is_string()) fail("must be a text");
    return json_.get<std::string>();
  }

  template <typename Table>
  auto word(const Table& table) const {
    const std::string word = text();
    for (const auto& [value, name] : table) {
      if (name == word) return value;
    }
    fail("\"" + word + "\" is not one of the known words");
  }

  Eigen::Vector3d vector() const {
    const std::vector<Node> nodes = elements(3);
    return {nodes[0].number(), nodes[1].number(), nodes[2].number()};
  }

  Eigen::Vector3d unitVector() const {
    const Eigen::Vector3d v = vector();
    if (std::abs(v.norm() - 1.0) > kUnitTolerance) fail("must have length 1");
    return v;
  }

  Eigen::Matrix3d matrix() const {
    const std::vector<Node> rows = elements(3);
    Eigen::Matrix3d matrix;
    for (int row = 0; row < 3; ++row) {
      matrix.row(row) = rows[static_cast<std::size_t>(row)].vector();
    }
    return matrix;
  }

  std::vector<double> numbers() const {
    std::vector<double> values;
    for (const Node& node : elements()) values.push_back(node.number());
    return values;
  }

  std::vector<int> integers() const {
    std::vector<int> values;
    for (const Node& node : elements()) values.push_back(node.integer());
    return values;
  }

 private:
  const Json& json_;
  std::string path_;
};

std::vector<Eigen::Vector3d> parseRing(const Node& node) {
  std::vector<Eigen::Vector3d> ring;
  for (const Node& vertex : node.elements()) ring.push_back(vertex.vector());
  if (ring.size() < 3) node.fail("a ring needs at least 3 vertices");
  return ring;
}

PlanarPolygon parsePolygon(const Node& node) {
  PlanarPolygon polygon;
  polygon.outer = parseRing(node["outer"]);
  for (const Node& hole : node["holes"].elements()) polygon.holes.push_back(parseRing(hole));
  return polygon;
}

PlanarMapPlane parsePlane(const Node& node) {
  PlanarMapPlane plane;
  plane.id = node["id"].integer();
  plane.plane = Plane::fromCoefficients(node["normal"].unitVector(), node["d"].number());
  plane.centroid = node["centroid"].vector();
  plane.area = node["area"].number();
  plane.points = node["points"].integer<long>();
  plane.rms = node["rms"].number();
  plane.family = node["family"].isNull() ? -1 : node["family"].integer();
  plane.kind = node["kind"].word(kPlaneKinds);
  for (const Node& polygon : node["polygons"].elements()) {
    plane.polygons.push_back(parsePolygon(polygon));
  }
  plane.orthogonal_to = node["orthogonal_to"].integers();
  plane.covariance = node["covariance"].matrix();
  plane.observations = node["observations"].numbers();
  return plane;
}

PlanarMapFamily parseFamily(const Node& node) {
  return {node["id"].integer(), node["normal"].unitVector(), node["planes"].integers()};
}

PlanarMapLine parseLine(const Node& node) {
  const std::vector<Node> planes = node["planes"].elements(2);
  return {node["id"].integer(),
          {planes[0].integer(), planes[1].integer()},
          node["start"].vector(),
          node["end"].vector(),
          node["kind"].word(kLineKinds)};
}

PlanarMapCorner parseCorner(const Node& node) {
  PlanarMapCorner corner;
  corner.id = node["id"].integer();
  const std::vector<Node> planes = node["planes"].elements(3);
  corner.planes = {planes[0].integer(), planes[1].integer(), planes[2].integer()};
  corner.position = node["position"].vector();
  const std::vector<Node> xyzw = node["orientation"].elements(4);
  corner.orientation =
      Eigen::Quaterniond(xyzw[3].number(), xyzw[0].number(), xyzw[1].number(), xyzw[2].number());
  if (std::abs(corner.orientation.norm() - 1.0) > kUnitTolerance) {
    node["orientation"].fail("must have length 1");
  }
  corner.kind = node["kind"].word(kCornerKinds);
  corner.covariance = node["covariance"].matrix();
  corner.observations = node["observations"].numbers();
  return corner;
}

/// Reads planes, lines and corners into a PlanarMap or its BarelySeen.
template <typename Elements>
void parseElements(const Node& root, Elements& elements) {
  for (const Node& node : root["planes"].elements()) elements.planes.push_back(parsePlane(node));
  for (const Node& node : root["lines"].elements()) elements.lines.push_back(parseLine(node));
  for (const Node& node : root["corners"].elements()) elements.corners.push_back(parseCorner(node));
}

/// Adds the ids of a list to `ids`.
template <typename Elements>
void addIds(const Elements& elements, const Node& list, std::set<int>& ids) {
  for (const auto& element : elements) {
    if (!ids.insert(element.id).second) {
      list.fail("id " + std::to_string(element.id) + " occurs twice");
    }
  }
}

template <typename Ids>
void requireKnown(const Ids& references, const std::set<int>& known, const Node& list) {
  for (const int id : references) {
    if (known.count(id) == 0) list.fail("refers to the missing id " + std::to_string(id));
  }
}

/// Ids and references of a PlanarMap or its BarelySeen. \param planes ids of the planes that may be
/// referred to beside its own, which are added.
template <typename Elements>
void checkElements(const Elements& elements, const Node& root, const std::set<int>& families,
                   std::set<int>& planes) {
  addIds(elements.planes, root["planes"], planes);
  std::set<int> lines, corners;
  addIds(elements.lines, root["lines"], lines);
  addIds(elements.corners, root["corners"], corners);
  for (const PlanarMapPlane& plane : elements.planes) {
    requireKnown(plane.orthogonal_to, planes, root["planes"]);
    if (plane.family >= 0) requireKnown(std::array{plane.family}, families, root["planes"]);
  }
  for (const auto& line : elements.lines) requireKnown(line.planes, planes, root["lines"]);
  for (const auto& corner : elements.corners) requireKnown(corner.planes, planes, root["corners"]);
}

void checkReferences(const PlanarMap& map, const Node& root) {
  std::set<int> planes, families;
  addIds(map.families, root["families"], families);
  checkElements(map, root, families, planes);
  for (const auto& family : map.families) requireKnown(family.planes, planes, root["families"]);
  if (root.has("barely_seen")) {
    checkElements(map.barely_seen, root["barely_seen"], families, planes);
  }
}

}  // namespace

PlanarMap parsePlanarMap(std::string_view text, const std::string& name) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw std::runtime_error(name + " is not JSON: " + error.what());
  }
  const Node root(json, name);
  if (root["format"].text() != "opp-planar-map") root.fail("is not a planar map of opp");
  if (root["version"].integer() != 1) root.fail("has a version that this program does not know");
  PlanarMap map;
  map.frame = root["frame"].text();
  parseElements(root, map);
  for (const Node& node : root["families"].elements()) map.families.push_back(parseFamily(node));
  if (root.has("barely_seen")) parseElements(root["barely_seen"], map.barely_seen);
  checkReferences(map, root);
  return map;
}

PlanarMap readPlanarMap(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || std::filesystem::is_directory(path)) {
    throw std::runtime_error(path.string() + " cannot be read; check the path");
  }
  return parsePlanarMap(text, path.string());
}

}  // namespace opp::mapping
