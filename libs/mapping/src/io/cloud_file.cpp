// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/cloud_file.h"

#include "opp/mapping/io/atomic_file.h"

#include "io/point_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <ostream>
#include <stdexcept>

namespace opp::mapping {
namespace {

std::string readWhole(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) throw std::runtime_error("is a folder");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot be opened; does it exist?");
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) throw std::runtime_error("cannot be read");
  return bytes;
}

PointTable readTable(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  try {
    const std::string file = readWhole(path);
    if (extension == ".ply") return readPly(file);
    if (extension == ".pcd") return readPcd(file);
    if (extension == ".xyz" || extension == ".txt") return readXyz(file);
    throw std::runtime_error("unknown kind of cloud; known are .ply, .pcd, .xyz and .txt");
  } catch (const std::exception& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
}

/// The vectors of three columns; empty if one of them is missing.
std::vector<Eigen::Vector3f> vectorsOf(const PointTable& table, const char* x, const char* y,
                                       const char* z) {
  std::vector<Eigen::Vector3f> vectors;
  for (const char* name : {x, y, z}) {
    if (table.columns.count(name) == 0) return vectors;
  }
  const auto& xs = table.columns.at(x);
  const auto& ys = table.columns.at(y);
  const auto& zs = table.columns.at(z);
  vectors.reserve(table.size);
  for (std::size_t i = 0; i < table.size; ++i) {
    vectors.push_back(Eigen::Vector3d(xs[i], ys[i], zs[i]).cast<float>());
  }
  return vectors;
}

PointCloud toCloud(const PointTable& table, const std::filesystem::path& path) {
  PointCloud cloud;
  cloud.points = vectorsOf(table, "x", "y", "z");
  if (table.columns.count("x") + table.columns.count("y") + table.columns.count("z") != 3) {
    throw std::runtime_error(path.string() + ": the points have no x, y and z");
  }
  cloud.normals = vectorsOf(table, "nx", "ny", "nz");
  cloud.rows = table.rows;
  cloud.cols = table.cols;
  cloud.viewpoint = table.viewpoint;
  return cloud;
}

int toLabel(double value) {
  constexpr double kLimit = std::numeric_limits<int>::max();
  return std::isfinite(value) ? static_cast<int>(std::clamp(std::round(value), -kLimit, kLimit))
                              : -1;
}

/// Appends the bytes of a 4-byte number, the lowest first.
template <typename Number>
void appendLittleEndian(std::string& bytes, Number number) {
  static_assert(sizeof(Number) == sizeof(std::uint32_t));
  std::uint32_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>(bits >> (8 * k) & 0xFFU);
}

}  // namespace

std::string columnName(std::string_view field) {
  for (const char axis : {'x', 'y', 'z'}) {
    const std::string name(1, axis);
    if (field == name) return name;
    if (field == "n" + name || field == "normal_" + name) return "n" + name;
  }
  return field == "label" || field == "intensity" ? std::string(field) : std::string();
}

PointCloud readCloudFile(const std::filesystem::path& path) {
  return toCloud(readTable(path), path);
}

LabeledCloud readLabeledCloudFile(const std::filesystem::path& path) {
  const PointTable table = readTable(path);
  auto column = table.columns.find("label");
  if (column == table.columns.end()) column = table.columns.find("intensity");
  if (column == table.columns.end()) {
    throw std::runtime_error(path.string() + ": the points have neither label nor intensity");
  }
  LabeledCloud result{toCloud(table, path), {}};
  for (const double value : column->second) result.labels.push_back(toLabel(value));
  return result;
}

void writeLabeledPly(const std::filesystem::path& path, const PointCloud& cloud,
                     const std::vector<int>& labels) {
  if (labels.size() != cloud.size())
    throw std::invalid_argument("a cloud needs one label per point");
  std::string body;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int k = 0; k < 3; ++k) appendLittleEndian(body, cloud.points[i][k]);
    appendLittleEndian(body, static_cast<std::int32_t>(labels[i]));
  }
  writeFileAtomically(path, [&](std::ostream& os) {
    os << "ply\nformat binary_little_endian 1.0\nelement vertex " << cloud.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nproperty int label\nend_header\n"
       << body;
  });
}

}  // namespace opp::mapping
