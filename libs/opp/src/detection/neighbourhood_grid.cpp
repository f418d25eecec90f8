// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detection/neighbourhood_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace opp {
namespace {

/// Random numbers of Steele et al., "Fast splittable pseudorandom number generators", 2014: one is
/// drawn per point, and they need to be different rather than good.
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}
  /// In [0, bound).
  std::uint32_t below(std::uint32_t bound) {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<std::uint32_t>(((z >> 32) * bound) >> 32);
  }

 private:
  std::uint64_t state_;
};

/// Fisher–Yates; std::shuffle may differ between standard libraries.
std::vector<std::uint32_t> shuffledIndices(std::size_t count, std::uint64_t seed) {
  std::vector<std::uint32_t> indices(count);
  std::iota(indices.begin(), indices.end(), 0U);
  SplitMix random(seed);
  for (std::size_t i = count; i > 1; --i) {
    std::swap(indices[i - 1], indices[random.below(static_cast<std::uint32_t>(i))]);
  }
  return indices;
}

/// floor; without SSE 4.1 std::floor is a call.
std::int64_t floorOf(double x) {
  const auto truncated = static_cast<std::int64_t>(x);
  return truncated - (static_cast<double>(truncated) > x ? 1 : 0);
}

/// Stands for the cell (i, j, k); linear, so that a step along an axis adds a constant. Cells with
/// equal keys count as one. Among 10⁵ cells that happens with a probability of 10⁻⁹, and a ball
/// then gets points that lie outside of it.
constexpr std::array<std::uint64_t, 3> kKeySteps = {0x9E3779B97F4A7C15ULL, 0xC2B2AE3D27D4EB4FULL,
                                                    0x165667B19E3779F9ULL};
template <typename Index>
std::uint64_t keyOf(const Index& index) {
  std::uint64_t key = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    key += static_cast<std::uint64_t>(index[axis]) * kKeySteps[axis];
  }
  return key;
}

}  // namespace

NeighbourhoodGrid::Index NeighbourhoodGrid::indexOf(const Eigen::Vector3f& x) const {
  // Far more cells than float32 coordinates can tell apart; keeps the conversion defined.
  static constexpr double kLargestIndex = 1e15;
  const auto index = [this](float value) {
    const double cells = static_cast<double>(value) * cells_per_metre_;
    return floorOf(std::min(std::max(cells, -kLargestIndex), kLargestIndex));
  };
  return {index(x.x()), index(x.y()), index(x.z())};
}

std::size_t NeighbourhoodGrid::markOf(std::uint64_t key) const {
  return (key ^ (key >> 29)) & (marks_.size() - 1);
}

std::size_t NeighbourhoodGrid::slotOf(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = (key ^ (key >> 29)) & mask;
  while (slots_[slot].cell >= 0 && slots_[slot].key != key) slot = (slot + 1) & mask;
  return slot;
}

std::int32_t NeighbourhoodGrid::cellAt(std::uint64_t key) {
  const std::size_t slot = slotOf(key);
  if (slots_[slot].cell >= 0) return slots_[slot].cell;
  const auto cell = static_cast<std::int32_t>(cells_.size());
  slots_[slot] = {key, cell};
  cells_.emplace_back();
  if (2 * cells_.size() > slots_.size()) {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& kept : old) {
      if (kept.cell >= 0) slots_[slotOf(kept.key)] = kept;
    }
  }
  return cell;
}

NeighbourhoodGrid::NeighbourhoodGrid(const std::vector<Eigen::Vector3f>& points, double cell,
                                     std::uint64_t seed)
    : cell_(cell), cells_per_metre_(1.0 / cell), slots_(64) {
  std::vector<std::uint32_t> cell_of(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    cell_of[i] = static_cast<std::uint32_t>(cellAt(keyOf(indexOf(points[i]))));
    ++cells_[cell_of[i]].end;
  }
  std::uint32_t begin = 0;
  for (Range& range : cells_) {
    const std::uint32_t size = range.end;
    range = {begin, begin};
    begin += size;
  }
  marks_.resize(kMarksPerSlot * slots_.size());
  for (const Slot& slot : slots_) {
    if (slot.cell >= 0) marks_[markOf(slot.key)] = 1;
  }
  order_.resize(points.size());
  for (const std::uint32_t i : shuffledIndices(points.size(), seed)) {
    order_[cells_[cell_of[i]].end++] = i;
  }
}

void NeighbourhoodGrid::cellsNear(const Eigen::Vector3f& center, double radius,
                                  std::vector<Range>& cells) const {
  const Index low = indexOf(center.array() - static_cast<float>(radius));
  const Index high = indexOf(center.array() + static_cast<float>(radius));
  // Squared distance from the center to the cell's slab along one axis.
  const auto gap = [&](int axis, std::int64_t index) {
    const double near = cell_ * static_cast<double>(index), x = static_cast<double>(center[axis]);
    const double distance = std::max({near - x, x - (near + cell_), 0.0});
    return distance * distance;
  };
  // Most cells are empty. Their marks are read without branches, which would be taken at random: a
  // few cells in a row, whose gaps and numbers fit into arrays.
  constexpr std::int64_t kRow = 8;
  std::array<double, kRow> gaps{};
  std::array<std::int64_t, kRow> marked{};
  for (std::int64_t begin = low[2]; begin <= high[2]; begin += kRow) {
    const std::int64_t row = std::min(kRow, high[2] + 1 - begin);
    for (std::int64_t k = 0; k < row; ++k) gaps[static_cast<std::size_t>(k)] = gap(2, begin + k);
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        const double left = radius * radius - gap(0, i) - gap(1, j);
        if (left < 0.0) continue;
        const std::uint64_t first = keyOf(Index{i, j, begin});
        const auto key = [&](std::int64_t k) {
          return first + static_cast<std::uint64_t>(k) * kKeySteps[2];
        };
        std::size_t count = 0;
        for (std::int64_t k = 0; k < row; ++k) {
          marked[count] = k;
          count += marks_[markOf(key(k))] & (gaps[static_cast<std::size_t>(k)] <= left ? 1U : 0U);
        }
        for (std::size_t m = 0; m < count; ++m) {
          const Slot& slot = slots_[slotOf(key(marked[m]))];
          if (slot.cell >= 0) cells.push_back(cells_[static_cast<std::size_t>(slot.cell)]);
        }
      }
    }
  }
}

}  // namespace opp
