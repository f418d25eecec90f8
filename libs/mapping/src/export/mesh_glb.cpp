// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/mesh_files.h"
#include "opp/mapping/io/atomic_file.h"

#include <tiny_gltf.h>

#include <cmath>
#include <cstring>
#include <ostream>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// Appends an array to the model's only buffer and describes it; returns its accessor.
template <typename Element>
int addArray(tinygltf::Model& model, const std::vector<Element>& elements, int target,
             int component_type, int type, std::size_t count) {
  std::vector<unsigned char>& bytes = model.buffers[0].data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = elements.size() * sizeof(Element);
  view.target = target;
  bytes.resize(bytes.size() + view.byteLength);
  std::memcpy(bytes.data() + view.byteOffset, elements.data(), view.byteLength);
  model.bufferViews.push_back(view);
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
  accessor.componentType = component_type;
  accessor.type = type;
  accessor.count = count;
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size()) - 1;
}

int addVectors(tinygltf::Model& model, const std::vector<Eigen::Vector3f>& vectors) {
  return addArray(model, vectors, TINYGLTF_TARGET_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_FLOAT,
                  TINYGLTF_TYPE_VEC3, vectors.size());
}

/// glTF demands the bounds of positions.
void setBounds(tinygltf::Accessor& accessor, const std::vector<Eigen::Vector3f>& points) {
  Eigen::Array3f low = points.front(), high = points.front();
  for (const Eigen::Vector3f& point : points) {
    low = low.min(point.array());
    high = high.max(point.array());
  }
  accessor.minValues = {low.x(), low.y(), low.z()};
  accessor.maxValues = {high.x(), high.y(), high.z()};
}

int addMaterial(tinygltf::Model& model, const Color& color) {
  // glTF's colours are linear; the palette is sRGB, whose gamma is close to 2.2.
  const auto linear = [](std::uint8_t channel) { return std::pow(channel / 255.0, 2.2); };
  tinygltf::Material material;
  material.pbrMetallicRoughness.baseColorFactor = {linear(color[0]), linear(color[1]),
                                                   linear(color[2]), 1.0};
  material.pbrMetallicRoughness.metallicFactor = 0.0;
  material.doubleSided = true;
  model.materials.push_back(material);
  return static_cast<int>(model.materials.size()) - 1;
}

int addPlane(tinygltf::Model& model, const PlaneMesh& plane) {
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] = addVectors(model, plane.vertices);
  setBounds(model.accessors.back(), plane.vertices);
  primitive.attributes["NORMAL"] =
      addVectors(model, std::vector<Eigen::Vector3f>(plane.vertices.size(), plane.normal));
  primitive.indices = addArray(model, plane.triangles, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                               TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                               3 * plane.triangles.size());
  primitive.material = addMaterial(model, plane.color);
  tinygltf::Mesh mesh;
  mesh.name = plane.name;
  mesh.primitives.push_back(primitive);
  model.meshes.push_back(mesh);
  tinygltf::Node node;
  node.name = plane.name;
  node.mesh = static_cast<int>(model.meshes.size()) - 1;
  model.nodes.push_back(node);
  return static_cast<int>(model.nodes.size()) - 1;
}

tinygltf::Model modelOf(const std::vector<PlaneMesh>& meshes) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "opp-mapping";
  tinygltf::Node root;
  root.name = "planar map";
  root.rotation = {-std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};  // z up to y up
  model.nodes.push_back(root);
  tinygltf::Scene scene;
  scene.nodes.push_back(0);
  model.scenes.push_back(scene);
  model.defaultScene = 0;
  if (!meshes.empty()) model.buffers.emplace_back();
  for (const PlaneMesh& mesh : meshes) {
    const int node = addPlane(model, mesh);
    model.nodes[0].children.push_back(node);
  }
  return model;
}

}  // namespace

void writeGlb(const std::filesystem::path& path, const std::vector<PlaneMesh>& meshes) {
  const tinygltf::Model model = modelOf(meshes);
  writeFileAtomically(path, [&](std::ostream& stream) {
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true)) {
      throw std::runtime_error(path.string() + " cannot be written as glTF");
    }
  });
}

}  // namespace opp::mapping
