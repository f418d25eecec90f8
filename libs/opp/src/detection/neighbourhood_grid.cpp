// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detection/neighbourhood_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

namespace opp {
namespace {

/// Fisher–Yates; std::shuffle may differ between standard libraries.
void shuffle(std::vector<std::uint32_t>& values, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  for (std::size_t i = values.size(); i > 1; --i) {
    std::swap(values[i - 1], values[engine() % i]);
  }
}

}  // namespace

NeighbourhoodGrid::Key NeighbourhoodGrid::keyOf(const Eigen::Vector3f& x) const {
  // Far more cells than float32 coordinates can tell apart; keeps the conversion defined.
  static constexpr double kLargestIndex = 1e15;
  const auto index = [this](float value) {
    const double cells = std::floor(static_cast<double>(value) / cell_);
    return static_cast<std::int64_t>(std::min(std::max(cells, -kLargestIndex), kLargestIndex));
  };
  return {index(x.x()), index(x.y()), index(x.z())};
}

std::size_t NeighbourhoodGrid::slotOf(const Key& key) const {
  // Three large odd constants spread neighbouring cells over the table (multiplicative hashing).
  const std::uint64_t hash = static_cast<std::uint64_t>(key[0]) * 0x9E3779B97F4A7C15ULL ^
                             static_cast<std::uint64_t>(key[1]) * 0xC2B2AE3D27D4EB4FULL ^
                             static_cast<std::uint64_t>(key[2]) * 0x165667B19E3779F9ULL;
  std::size_t slot = (hash ^ (hash >> 29)) & (slots_.size() - 1);
  while (slots_[slot].cell >= 0 && slots_[slot].key != key) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

NeighbourhoodGrid::NeighbourhoodGrid(const std::vector<Eigen::Vector3f>& points, double cell,
                                     std::uint64_t seed)
    : cell_(cell) {
  std::size_t capacity = 16;
  while (capacity < 2 * points.size()) capacity *= 2;
  slots_.resize(capacity);
  std::vector<std::uint32_t> cell_of(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    Slot& slot = slots_[slotOf(keyOf(points[i]))];
    if (slot.cell < 0) {
      slot = {keyOf(points[i]), static_cast<std::int32_t>(cells_.size())};
      cells_.emplace_back();
    }
    cell_of[i] = static_cast<std::uint32_t>(slot.cell);
    ++cells_[cell_of[i]].end;
  }
  std::uint32_t begin = 0;
  for (Range& range : cells_) {
    const std::uint32_t size = range.end;
    range = {begin, begin};
    begin += size;
  }
  std::vector<std::uint32_t> shuffled(points.size());
  std::iota(shuffled.begin(), shuffled.end(), 0U);
  shuffle(shuffled, seed);
  order_.resize(points.size());
  for (const std::uint32_t i : shuffled) order_[cells_[cell_of[i]].end++] = i;
}

void NeighbourhoodGrid::cellsNear(const Eigen::Vector3f& center, double radius,
                                  std::vector<Range>& cells) const {
  const Key low = keyOf(center.array() - static_cast<float>(radius));
  const Key high = keyOf(center.array() + static_cast<float>(radius));
  // Squared distance from the center to the cell's slab along one axis.
  const auto gap = [&](int axis, std::int64_t index) {
    const double near = cell_ * static_cast<double>(index), x = static_cast<double>(center[axis]);
    const double distance = std::max({near - x, x - (near + cell_), 0.0});
    return distance * distance;
  };
  for (std::int64_t i = low[0]; i <= high[0]; ++i) {
    for (std::int64_t j = low[1]; j <= high[1]; ++j) {
      const double gap_ij = gap(0, i) + gap(1, j);
      if (gap_ij > radius * radius) continue;
      for (std::int64_t k = low[2]; k <= high[2]; ++k) {
        if (gap_ij + gap(2, k) > radius * radius) continue;
        const Slot& slot = slots_[slotOf({i, j, k})];
        if (slot.cell >= 0) cells.push_back(cells_[static_cast<std::size_t>(slot.cell)]);
      }
    }
  }
}

}  // namespace opp
