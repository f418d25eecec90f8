// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/build_scene.h"

#include "opp/mapping/export/plane_mesh.h"
#include "opp/mapping/io/mrpt_convert.h"

#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/stock_objects.h>

namespace opp::mapping {
namespace {

using mrpt::img::TColor;
using mrpt::math::TPoint3Df;
using mrpt::opengl::CSetOfLines;
using mrpt::opengl::CSetOfObjects;
using mrpt::opengl::CSetOfTriangles;

constexpr float kCornerAxes = 0.25F;  ///< [m]

CSetOfObjects::Ptr planesOf(const PlanarMap& map) {
  auto planes = CSetOfObjects::Create();
  planes->setName("planes");
  for (const PlaneMesh& mesh : triangulate(map)) {
    auto triangles = CSetOfTriangles::Create();
    triangles->setName(mesh.name);
    triangles->cullFaces(mrpt::opengl::TCullFace::BACK);
    for (const auto& corners : mesh.triangles) {
      const auto vertex = [&](std::size_t k) {
        const Eigen::Vector3f& v = mesh.vertices[corners[k]];
        return TPoint3Df(v.x(), v.y(), v.z());
      };
      mrpt::opengl::TTriangle triangle(vertex(0), vertex(1), vertex(2));
      triangle.setColor(TColor(mesh.color[0], mesh.color[1], mesh.color[2]));
      triangles->insertTriangle(triangle);
    }
    planes->insert(triangles);
  }
  return planes;
}

CSetOfLines::Ptr linesNamed(const std::string& name, const TColor& color, float width) {
  auto lines = CSetOfLines::Create();
  lines->setName(name);
  lines->setColor_u8(color);
  lines->setLineWidth(width);
  return lines;
}

void append(CSetOfLines& lines, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  lines.appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
}

void appendRing(CSetOfLines& lines, const std::vector<Eigen::Vector3d>& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    append(lines, ring[i], ring[(i + 1) % ring.size()]);
  }
}

CSetOfLines::Ptr outlinesOf(const PlanarMap& map) {
  auto outlines = linesNamed("outlines", TColor(90, 90, 90), 1.0F);
  for (const PlanarMapPlane& plane : map.planes) {
    for (const PlanarPolygon& polygon : plane.polygons) {
      appendRing(*outlines, polygon.outer);
      for (const auto& hole : polygon.holes) appendRing(*outlines, hole);
    }
  }
  return outlines;
}

CSetOfObjects::Ptr cornersOf(const PlanarMap& map) {
  auto corners = CSetOfObjects::Create();
  corners->setName("corners");
  for (const PlanarMapCorner& corner : map.corners) {
    Eigen::Isometry3d map_from_corner(corner.orientation.normalized());
    map_from_corner.translation() = corner.position;
    auto axes = mrpt::opengl::stock_objects::CornerXYZ(kCornerAxes);
    axes->setName("corner " + std::to_string(corner.id));
    axes->setPose(toCPose3D(map_from_corner));
    corners->insert(axes);
  }
  return corners;
}

}  // namespace

mrpt::opengl::COpenGLScene::Ptr buildScene(const PlanarMap& map, const Trajectory& trajectory) {
  auto scene = mrpt::opengl::COpenGLScene::Create();
  scene->insert(planesOf(map));
  scene->insert(outlinesOf(map));
  auto lines = linesNamed("lines", TColor(20, 20, 20), 3.0F);
  for (const PlanarMapLine& line : map.lines) append(*lines, line.start, line.end);
  scene->insert(lines);
  scene->insert(cornersOf(map));
  auto way = linesNamed("trajectory", TColor(192, 57, 43), 2.0F);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    append(*way, trajectory[i - 1].map_from_body.translation(),
           trajectory[i].map_from_body.translation());
  }
  scene->insert(way);
  return scene;
}

}  // namespace opp::mapping
