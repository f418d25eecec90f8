// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/normal_space_sampling.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace opp::mapping {
namespace {

// Directions are told apart by the cells of a 4×4 grid on each face of a cube: about 20° each.
constexpr int kCellsPerSide = 4;
constexpr int kDirections = 6 * kCellsPerSide * kCellsPerSide;

int directionOf(const Eigen::Vector3f& normal) {
  int axis = 0;
  const float largest = normal.cwiseAbs().maxCoeff(&axis);
  const auto cell = [&](int other) {
    const float u = 0.5F * (normal[other % 3] / largest + 1.0F) * kCellsPerSide;
    return std::clamp(static_cast<int>(u), 0, kCellsPerSide - 1);
  };
  const int face = 2 * axis + (normal[axis] > 0.0F ? 1 : 0);
  return (face * kCellsPerSide + cell(axis + 1)) * kCellsPerSide + cell(axis + 2);
}

}  // namespace

std::vector<std::uint32_t> sampleNormalSpace(const OrientedCloud& cloud, std::size_t max_count) {
  std::vector<std::uint32_t> chosen(cloud.size());
  std::iota(chosen.begin(), chosen.end(), 0U);
  if (cloud.size() <= max_count) return chosen;

  std::array<std::vector<std::uint32_t>, kDirections> members;
  for (const std::uint32_t i : chosen) {
    members[static_cast<std::size_t>(directionOf(cloud.normals[i]))].push_back(i);
  }
  // Fill the smallest groups first; what they leave of their share goes to the larger ones.
  std::sort(members.begin(), members.end(), [](const auto& a, const auto& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  chosen.clear();
  for (std::size_t g = 0; g < members.size(); ++g) {
    const std::size_t share = (max_count - chosen.size()) / (members.size() - g);
    const std::size_t count = std::min(share, members[g].size());
    for (std::size_t k = 0; k < count; ++k)
      chosen.push_back(members[g][k * members[g].size() / count]);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace opp::mapping
