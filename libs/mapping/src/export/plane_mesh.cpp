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

/// Triangulation of one polygon; its vertices are found again by their exact coordinates.
class PolygonTriangulator {
 public:
  PolygonTriangulator(const PlaneFrame& frame, PlaneMesh& mesh) : frame_(frame), mesh_(mesh) {}

  void add(const PlanarPolygon& polygon) {
    indices_.clear();
    Polygon2d flat{addRing(polygon.outer), {}};
    for (const auto& hole : polygon.holes) flat.holes.push_back(addRing(hole));
    const auto triangles = geos_.polygonsOf(geos_.triangulate(geos_.polygon(flat)));
    for (const Polygon2d& triangle : triangles) {
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) corners[k] = indexOf(triangle.outer.at(k));
      mesh_.triangles.push_back(corners);
    }
  }

 private:
  Ring2d addRing(const std::vector<Eigen::Vector3d>& ring) {
    Ring2d flat;
    for (const Eigen::Vector3d& vertex : ring) {
      flat.push_back(frame_.project(vertex));
      indices_[{flat.back().x(), flat.back().y()}] =
          static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(vertex.cast<float>());
    }
    return flat;
  }

  std::uint32_t indexOf(const Eigen::Vector2d& vertex) const {
    const auto found = indices_.find({vertex.x(), vertex.y()});
    if (found == indices_.end()) {
      throw std::runtime_error(mesh_.name + " has a polygon that crosses itself");
    }
    return found->second;
  }

  const PlaneFrame& frame_;
  PlaneMesh& mesh_;
  Geos geos_;
  std::map<std::pair<double, double>, std::uint32_t> indices_;
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
