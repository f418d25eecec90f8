// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// Cubic cells of space and one number for each occupied one: a hash table with open addressing,
/// because one allocation per cell would dominate the run time.
class CellTable {
 public:
  using Cell = Eigen::Array3i;

  /// Cells of `edge` > 0 [m] that start at `origin`; room for `expected` cells before it grows.
  CellTable(const Eigen::Vector3f& origin, double edge, std::size_t expected)
      : origin_(origin.cast<double>()), inverse_edge_(1.0 / edge) {
    std::size_t capacity = 64;
    while (capacity < 2 * expected) capacity *= 2;
    slots_.resize(capacity);
  }

  /// Empties the table, now for cells of `edge` [m].
  void reset(double edge) {
    inverse_edge_ = 1.0 / edge;
    std::fill(slots_.begin(), slots_.end(), Slot());
    size_ = 0;
  }

  Cell cellOf(const Eigen::Vector3d& point) const {
    const Eigen::Array3d cells = (point - origin_).array() * inverse_edge_;
    const Cell truncated = cells.cast<int>();
    // Rounds down; without SSE 4.1 std::floor is a call.
    return truncated - (truncated.cast<double>() > cells).cast<int>();
  }

  std::size_t size() const { return size_; }

  /// The number kept for `cell`, −1 if it was not there yet; then it keeps `value`.
  int findOrInsert(const Cell& cell, int value) {
    Slot& slot = slots_[locate(keyOf(cell))];
    if (slot.value >= 0) return slot.value;
    slot = {keyOf(cell), value};
    if (++size_ * 2 > slots_.size()) grow();
    return -1;
  }

  /// The number kept for `cell`, −1 if none.
  int find(const Cell& cell) const { return slots_[locate(keyOf(cell))].value; }

  /// Replaces the number of a cell that is there.
  void replace(const Cell& cell, int value) { slots_[locate(keyOf(cell))].value = value; }

 private:
  struct Slot {
    std::uint64_t key = 0;
    int value = -1;
  };

  /// 21 bits per axis; `spacingForCount` keeps cells large enough for that.
  static std::uint64_t keyOf(const Cell& cell) {
    constexpr std::uint64_t kMask = (1U << 21) - 1;
    return (static_cast<std::uint64_t>(cell.x() + 1) & kMask) << 42 |
           (static_cast<std::uint64_t>(cell.y() + 1) & kMask) << 21 |
           (static_cast<std::uint64_t>(cell.z() + 1) & kMask);
  }

  std::size_t locate(std::uint64_t key) const {
    constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;  // 2^64 / golden ratio (Knuth)
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = static_cast<std::size_t>((key * kGolden) >> 24) & mask;
    while (slots_[at].value >= 0 && slots_[at].key != key) at = (at + 1) & mask;
    return at;
  }

  void grow() {
    std::vector<Slot> old(slots_.size() * 2);
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.value >= 0) slots_[locate(slot.key)] = slot;
    }
  }

  Eigen::Vector3d origin_;
  double inverse_edge_;
  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

}  // namespace opp
