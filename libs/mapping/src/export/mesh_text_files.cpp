// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/mesh_files.h"
#include "opp/mapping/io/atomic_file.h"

#include <charconv>
#include <ostream>
#include <string>

namespace opp::mapping {
namespace {

/// Appends the shortest text that reads back as the same number; no locale.
void append(std::string& text, float value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  text.append(buffer.data(), end);
}

void append(std::string& text, const Eigen::Vector3f& vector) {
  for (const float value : vector) {
    text += ' ';
    append(text, value);
  }
}

void write(const std::filesystem::path& path, const std::string& text) {
  writeFileAtomically(path, [&](std::ostream& stream) { stream << text; });
}

}  // namespace

void writePly(const std::filesystem::path& path, const std::vector<PlaneMesh>& meshes) {
  std::string vertices, faces;
  std::size_t vertex_count = 0, face_count = 0;
  for (const PlaneMesh& mesh : meshes) {
    for (const auto& corners : mesh.triangles) {
      faces += '3';
      for (const std::uint32_t corner : corners) {
        faces += ' ' + std::to_string(vertex_count + corner);
      }
      faces += '\n';
    }
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      std::string line;
      append(line, vertex);
      append(line, mesh.normal);
      for (const int channel : mesh.color) line += ' ' + std::to_string(channel);
      vertices += line.substr(1) + '\n';
    }
    vertex_count += mesh.vertices.size();
    face_count += mesh.triangles.size();
  }
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertex_count) + '\n';
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    text += std::string("property float ") + name + '\n';
  }
  for (const char* name : {"red", "green", "blue"}) {
    text += std::string("property uchar ") + name + '\n';
  }
  text += "element face " + std::to_string(face_count) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  write(path, text + vertices + faces);
}

void writeObj(const std::filesystem::path& path, const std::vector<PlaneMesh>& meshes) {
  std::string text = "# Planar map of opp, metres, z up\n";
  std::size_t first_vertex = 1;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const PlaneMesh& mesh = meshes[m];
    text += "o " + mesh.name + "\nvn";
    append(text, mesh.normal);
    text += '\n';
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      text += 'v';
      append(text, vertex);
      for (const std::uint8_t channel : mesh.color) {
        text += ' ';
        append(text, static_cast<float>(channel) / 255.0F);
      }
      text += '\n';
    }
    for (const auto& corners : mesh.triangles) {
      text += 'f';
      for (const std::uint32_t corner : corners) {
        text += ' ' + std::to_string(first_vertex + corner) + "//" + std::to_string(m + 1);
      }
      text += '\n';
    }
    first_vertex += mesh.vertices.size();
  }
  write(path, text);
}

}  // namespace opp::mapping
