// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "coverage.h"

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

Eigen::Vector2i floored(const Eigen::Vector2d& v) {
  return {static_cast<int>(std::floor(v.x())), static_cast<int>(std::floor(v.y()))};
}

}  // namespace

Coverage::Coverage(const Face& face, const Plane& side_plane, double cell)
    : coordinates_(side_plane), cell_(cell) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
  for (const auto& vertex : face.outer) {
    low = low.cwiseMin(coordinates_.uv(vertex));
    high = high.cwiseMax(coordinates_.uv(vertex));
  }
  first_ = floored(low / cell);
  size_ = floored(high / cell) - first_ + Eigen::Vector2i::Ones();
  counts_.assign(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()), 0);
}

Eigen::Vector2i Coverage::cellOf(const Eigen::Vector3d& point) const {
  return floored(coordinates_.uv(point) / cell_) - first_;
}

void Coverage::add(const Eigen::Vector3d& point) {
  const Eigen::Vector2i at = cellOf(point);
  const int u = std::clamp(at.x(), 0, size_.x() - 1), v = std::clamp(at.y(), 0, size_.y() - 1);
  ++counts_[static_cast<std::size_t>(v) * static_cast<std::size_t>(size_.x()) +
            static_cast<std::size_t>(u)];
  ++total_;
}

std::uint32_t Coverage::count(int u, int v) const {
  if (u < 0 || v < 0 || u >= size_.x() || v >= size_.y()) return 0;
  return counts_[static_cast<std::size_t>(v) * static_cast<std::size_t>(size_.x()) +
                 static_cast<std::size_t>(u)];
}

bool Coverage::seenNear(const Eigen::Vector3d& point, int radius) const {
  const Eigen::Vector2i at = cellOf(point);
  for (int v = at.y() - radius; v <= at.y() + radius; ++v) {
    for (int u = at.x() - radius; u <= at.x() + radius; ++u) {
      if (count(u, v) > 0) return true;
    }
  }
  return false;
}

void Coverage::forEachSeen(
    const std::function<void(const Eigen::Vector3d&, std::uint32_t)>& visit) const {
  for (int v = 0; v < size_.y(); ++v) {
    for (int u = 0; u < size_.x(); ++u) {
      if (count(u, v) == 0) continue;
      const Eigen::Vector2d centre =
          cell_ * ((first_ + Eigen::Vector2i(u, v)).cast<double>() + Eigen::Vector2d(0.5, 0.5));
      visit(coordinates_.point(centre), count(u, v));
    }
  }
}

void Coverage::addTo(CellMask& mask) const {
  for (int v = 0; v < size_.y(); ++v) {
    for (int u = 0; u < size_.x(); ++u) {
      if (count(u, v) > 0) mask.insert(first_ + Eigen::Vector2i(u, v));
    }
  }
}

}  // namespace opp::mapping
