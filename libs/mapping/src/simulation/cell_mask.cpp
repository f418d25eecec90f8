// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cell_mask.h"

namespace opp::mapping {

CellMask::CellMask(const Eigen::Vector2i& low, const Eigen::Vector2i& high)
    : low_(low),
      size_(high - low + Eigen::Vector2i::Ones()),
      cells_(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()), 0) {}

void CellMask::insert(const Eigen::Vector2i& cell) {
  const Eigen::Vector2i at = cell - low_;
  cells_[static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(size_.x()) +
         static_cast<std::size_t>(at.x())] = 1;
}

bool CellMask::contains(const Eigen::Vector2i& cell) const {
  const Eigen::Vector2i at = cell - low_;
  if (at.minCoeff() < 0 || at.x() >= size_.x() || at.y() >= size_.y()) return false;
  return cells_[static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(size_.x()) +
                static_cast<std::size_t>(at.x())] != 0;
}

CellMask CellMask::filtered(int radius, int axis, bool any) const {
  CellMask result(low_, low_ + size_ - Eigen::Vector2i::Ones());
  const Eigen::Vector2i step = Eigen::Vector2i::Unit(axis);
  for (int v = low_.y(); v < low_.y() + size_.y(); ++v) {
    for (int u = low_.x(); u < low_.x() + size_.x(); ++u) {
      bool found = !any;
      for (int k = -radius; k <= radius && found != any; ++k) {
        found = contains(Eigen::Vector2i(u, v) + k * step);
      }
      if (found) result.insert({u, v});
    }
  }
  return result;
}

CellMask CellMask::closed(int radius) const {
  const Eigen::Vector2i margin = Eigen::Vector2i::Constant(radius);
  CellMask wide(low_ - margin, low_ + size_ - Eigen::Vector2i::Ones() + margin);
  for (int v = low_.y(); v < low_.y() + size_.y(); ++v) {
    for (int u = low_.x(); u < low_.x() + size_.x(); ++u) {
      if (contains({u, v})) wide.insert({u, v});
    }
  }
  return wide.filtered(radius, 0, true)
      .filtered(radius, 1, true)
      .filtered(radius, 0, false)
      .filtered(radius, 1, false);
}

std::vector<Polygon2d> CellMask::runs(double cell) const {
  std::vector<Polygon2d> result;
  for (int v = low_.y(); v < low_.y() + size_.y(); ++v) {
    for (int u = low_.x(); u < low_.x() + size_.x(); ++u) {
      if (!contains({u, v})) continue;
      const Eigen::Vector2d low = cell * Eigen::Vector2d(u, v);
      while (contains({u, v})) ++u;
      const Eigen::Vector2d high = cell * Eigen::Vector2d(u, v + 1);
      result.push_back({{low, {high.x(), low.y()}, high, {low.x(), high.y()}}, {}});
    }
  }
  return result;
}

}  // namespace opp::mapping
