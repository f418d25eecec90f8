// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/plane_mesh.h"

#include "opp/mapping/planar/plane_extent.h"

#include "io/planar_map_names.h"
#include "planar/geos.h"

#include <map>
#include <stdexcept>
#include <utility>

namespace opp::mapping {
namespace {

constexpr Color kFloorColor{186, 171, 148};
constexpr Color kCeilingColor{214, 224, 232};
/// Told apart by people with and without colour blindness (after Okabe and Ito).
constexpr std::array<Color, 7> kFamilyColors{{{86, 180, 233},
                                              {230, 159, 0},
                                              {0, 158, 115},
                                              {204, 121, 167},
                                              {240, 228, 66},
                                              {0, 114, 178},
                                              {213, 94, 0}}};
constexpr Color kLonePlaneColor{153, 153, 153};

Color colorOf(const PlanarMapPlane& plane) {
  if (plane.kind == PlaneKind::kFloor) return kFloorColor;
  if (plane.kind == PlaneKind::kCeiling) return kCeilingColor;
  if (plane.family < 0) return kLonePlaneColor;
  return kFamilyColors[static_cast<std::size_t>(plane.family) % kFamilyColors.size()];
}

/// Adds polygons to a mesh; their vertices are found again by their exact coordinates.
class PolygonTriangulator {
 public:
  PolygonTriangulator(const PlaneFrame& frame, PlaneMesh& mesh) : frame_(frame), mesh_(mesh) {}

  void add(const PlanarPolygon& polygon) {
    Polygon2d flat{flattened(polygon.outer), {}};
    for (const auto& hole : polygon.holes) flat.holes.push_back(flattened(hole));
    try {
      add(flat);
    } catch (const std::runtime_error&) {  // it crosses or touches itself
      for (const Polygon2d& part : geos_.polygonsOf(geos_.untied(geos_.polygon(flat)))) add(part);
    }
  }

 private:
  Ring2d flattened(const std::vector<Eigen::Vector3d>& ring) const {
    Ring2d flat;
    for (const Eigen::Vector3d& vertex : ring) flat.push_back(frame_.project(vertex));
    return flat;
  }

  void add(const Polygon2d& polygon) {
    std::map<std::pair<double, double>, std::uint32_t> indices;
    std::vector<Eigen::Vector3f> vertices;
    const auto add_ring = [&](const Ring2d& ring) {
      for (const Eigen::Vector2d& vertex : ring) {
        const auto index = static_cast<std::uint32_t>(mesh_.vertices.size() + vertices.size());
        indices[{vertex.x(), vertex.y()}] = index;
        vertices.push_back(frame_.lift(vertex).cast<float>());
      }
    };
    add_ring(polygon.outer);
    for (const Ring2d& hole : polygon.holes) add_ring(hole);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const Polygon2d& part : geos_.polygonsOf(geos_.triangulate(geos_.polygon(polygon)))) {
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto found = indices.find({part.outer.at(k).x(), part.outer.at(k).y()});
        if (found == indices.end()) throw std::runtime_error("a triangle has a foreign vertex");
        corners[k] = found->second;
      }
      triangles.push_back(corners);
    }
    mesh_.vertices.insert(mesh_.vertices.end(), vertices.begin(), vertices.end());
    mesh_.triangles.insert(mesh_.triangles.end(), triangles.begin(), triangles.end());
  }

  const PlaneFrame& frame_;
  PlaneMesh& mesh_;
  Geos geos_;
};

}  // namespace

std::vector<PlaneMesh> triangulate(const PlanarMap& map) {
  std::vector<PlaneMesh> meshes;
  for (const PlanarMapPlane& plane : map.planes) {
    if (plane.polygons.empty()) continue;
    PlaneMesh mesh;
    mesh.name = std::string(wordOf(kPlaneKinds, plane.kind)) + " " + std::to_string(plane.id);
    mesh.normal = plane.plane.normal().cast<float>();
    mesh.color = colorOf(plane);
    const PlaneFrame frame(plane.plane, Eigen::Vector3d::UnitX());
    PolygonTriangulator triangulator(frame, mesh);
    for (const PlanarPolygon& polygon : plane.polygons) triangulator.add(polygon);
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace opp::mapping
