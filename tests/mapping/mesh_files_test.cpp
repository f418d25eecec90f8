// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/mesh_files.h"

#include "opp/mapping/core/move_planar_map.h"

#include "support/random.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <sstream>

namespace opp::mapping {
namespace {

/// A square of edge 4 with a square hole of edge 2, on a given plane.
PlanarMapPlane frameOn(const Plane& plane, int id) {
  const Eigen::Matrix<double, 3, 2> axes = tangentBasis(plane.normal());
  const auto square = [&](double half) {
    std::vector<Eigen::Vector3d> ring;
    for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      ring.push_back(half * (u * axes.col(0) + v * axes.col(1)) - plane.d() * plane.normal());
    }
    return ring;
  };
  PlanarMapPlane result;
  result.id = id;
  result.plane = plane;
  result.kind = PlaneKind::kWall;
  result.family = id;
  result.polygons = {{square(2.0), {square(1.0)}}};
  std::reverse(result.polygons[0].holes[0].begin(), result.polygons[0].holes[0].end());
  return result;
}

PlanarMap twoPlanes() {
  PlanarMap map;
  map.planes = {frameOn(Plane::fromCoefficients({0.0, 0.0, 1.0}, 1.0), 0),
                frameOn(Plane::fromCoefficients({1.0, 0.0, 0.0}, -3.0), 1)};
  map.planes.push_back(PlanarMapPlane());  // without polygons: in no file
  return map;
}

TEST(Triangulate, FillsThePolygonAndLeavesTheHole) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    PlanarMap map;
    map.planes = {
        frameOn(Plane::fromCoefficients(random.unitVector(), random.uniform(-3.0, 3.0)), 5)};
    const auto meshes = triangulate(map);
    ASSERT_EQ(meshes.size(), 1U);
    EXPECT_EQ(meshes[0].name, "wall 5");
    EXPECT_EQ(meshes[0].vertices.size(), 8U);
    EXPECT_EQ(meshes[0].triangles.size(), 8U);  // n + 2 holes − 2 = 8 + 2 − 2
    float area = 0.0F;
    for (const auto& [a, b, c] : meshes[0].triangles) {
      const auto& v = meshes[0].vertices;
      const float triangle = 0.5F * (v[b] - v[a]).cross(v[c] - v[a]).dot(meshes[0].normal);
      EXPECT_GT(triangle, 0.0F) << "counter-clockwise";
      area += triangle;
    }
    EXPECT_NEAR(area, 12.0F, 1e-4F);  // float vertices
  }
}

TEST(Triangulate, EmptyMapHasNoMesh) { EXPECT_TRUE(triangulate(PlanarMap()).empty()); }

TEST(Triangulate, FillsWhatACrossingOutlineEncloses) {
  PlanarMap map = twoPlanes();
  map.planes[0].polygons[0].holes.clear();
  std::swap(map.planes[0].polygons[0].outer[0], map.planes[0].polygons[0].outer[1]);
  const PlaneMesh mesh = triangulate(map)[0];
  float area = 0.0F;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& v = mesh.vertices;
    area += 0.5F * (v[b] - v[a]).cross(v[c] - v[a]).dot(mesh.normal);
  }
  EXPECT_NEAR(area, 8.0F, 1e-4F);  // an hourglass of two triangles in a square of 16 m²
}

TEST(Triangulate, SurvivesSpikesThatRoundingTurnsInsideOut) {
  test::Random random(2);
  for (int k = 0; k < 200; ++k) {
    PlanarMap map = twoPlanes();
    map.planes.resize(1);
    auto& outer = map.planes[0].polygons[0].outer;
    const Eigen::Vector3d tip = outer[0] + random.uniform(0.1, 1.0) * (outer[0] - outer[1]);
    outer.insert(outer.begin() + 1, tip);  // there and back along the edge
    const auto turned = movedPlanarMap(random.pose(5.0), map);
    float area = 0.0F;
    for (const PlaneMesh& mesh : triangulate(turned)) {
      for (const auto& [a, b, c] : mesh.triangles) {
        const auto& v = mesh.vertices;
        area += 0.5F * (v[b] - v[a]).cross(v[c] - v[a]).dot(mesh.normal);
      }
    }
    EXPECT_NEAR(area, 12.0F, 1e-4F) << k;
  }
}

TEST(WritePly, StatesItsContents) {
  const test::TempFolder folder;
  writePly(folder / "map.ply", triangulate(twoPlanes()));
  const std::string text = test::readFile(folder / "map.ply");
  EXPECT_EQ(text.rfind("ply\nformat ascii 1.0\nelement vertex 16\n", 0), 0U);
  EXPECT_NE(text.find("element face 16\n"), std::string::npos);
  std::istringstream body(text.substr(text.find("end_header\n") + 11));
  for (int i = 0; i < 16; ++i) {
    double x = 0, y = 0, z = 0, nx = 0, ny = 0, nz = 0;
    int r = 0, g = 0, b = 0;
    ASSERT_TRUE(body >> x >> y >> z >> nx >> ny >> nz >> r >> g >> b);
    EXPECT_NEAR(i < 8 ? z : x, i < 8 ? -1.0 : 3.0, 1e-6);
  }
  for (int i = 0; i < 16; ++i) {
    int count = 0, a = 0, b = 0, c = 0;
    ASSERT_TRUE(body >> count >> a >> b >> c);
    EXPECT_EQ(count, 3);
    EXPECT_EQ(a / 8, i / 8) << "a triangle stays on its plane";
    EXPECT_LT(std::max({a, b, c}), 16);
  }
  EXPECT_FALSE(body >> std::ws && !body.eof());
}

TEST(WriteObj, IndicesCountFromOneOverAllObjects) {
  const test::TempFolder folder;
  writeObj(folder / "map.obj", triangulate(twoPlanes()));
  std::istringstream text(test::readFile(folder / "map.obj"));
  std::string line;
  int vertices = 0, faces = 0, objects = 0;
  while (std::getline(text, line)) {
    if (line.rfind("o ", 0) == 0) ++objects;
    if (line.rfind("v ", 0) == 0) ++vertices;
    if (line.rfind("f ", 0) != 0) continue;
    ++faces;
    std::istringstream words(line.substr(2));
    for (std::string word; words >> word;) {
      const int index = std::stoi(word);
      EXPECT_GE(index, 8 * (objects - 1) + 1);
      EXPECT_LE(index, 8 * objects);
      EXPECT_EQ(word.substr(word.find("//") + 2), std::to_string(objects));
    }
  }
  EXPECT_EQ(objects, 2);
  EXPECT_EQ(vertices, 16);
  EXPECT_EQ(faces, 16);
}

TEST(WriteGlb, LoadsAgainWithItsPlanes) {
  const test::TempFolder folder;
  writeGlb(folder / "map.glb", triangulate(twoPlanes()));
  tinygltf::Model model;
  std::string error, warning;
  ASSERT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning,
                                                      (folder / "map.glb").string()))
      << error;
  EXPECT_EQ(error + warning, "");
  ASSERT_EQ(model.meshes.size(), 2U);
  EXPECT_EQ(model.meshes[1].name, "wall 1");
  const auto& positions = model.accessors[static_cast<std::size_t>(
      model.meshes[1].primitives[0].attributes.at("POSITION"))];
  EXPECT_EQ(positions.count, 8U);
  EXPECT_NEAR(positions.minValues[0], 3.0, 1e-6);
  EXPECT_EQ(model.nodes[0].children.size(), 2U);
  writeGlb(folder / "again.glb", triangulate(twoPlanes()));
  EXPECT_EQ(test::readFile(folder / "map.glb"), test::readFile(folder / "again.glb"));
}

TEST(MeshFiles, EmptyMapsAndBadFolders) {
  const test::TempFolder folder;
  writePly(folder / "a.ply", {});
  writeObj(folder / "a.obj", {});
  writeGlb(folder / "a.glb", {});
  EXPECT_NE(test::readFile(folder / "a.ply").find("element vertex 0"), std::string::npos);
  tinygltf::Model model;
  std::string error, warning;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning,
                                                      (folder / "a.glb").string()))
      << error;
  EXPECT_THROW(writePly("/nowhere/a.ply", {}), std::runtime_error);
  EXPECT_THROW(writeObj("/nowhere/a.obj", {}), std::runtime_error);
  EXPECT_THROW(writeGlb("/nowhere/a.glb", {}), std::runtime_error);
}

}  // namespace
}  // namespace opp::mapping
