// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace opp {

/// Points sorted into cubic cells, in random order within each cell: any stretch of a cell is an
/// even sample of it. Stands in for the radius search of the paper.
class NeighbourhoodGrid {
 public:
  /// Stretch [begin, end) of `order()`.
  struct Range {
    std::uint32_t begin = 0, end = 0;
    std::uint32_t size() const { return end - begin; }
  };

  /// Sorts `points` (finite) into cells of `cell` > 0 [m]. O(size). Same seed, same order.
  NeighbourhoodGrid(const std::vector<Eigen::Vector3f>& points, double cell, std::uint64_t seed);

  /// Indices of the points, cell by cell.
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// Appends the non-empty cells that the ball about `center` touches. O((radius / cell)³).
  void cellsNear(const Eigen::Vector3f& center, double radius, std::vector<Range>& cells) const;

 private:
  using Index = std::array<std::int64_t, 3>;
  struct Slot {
    std::uint64_t key = 0;
    std::int32_t cell = -1;
  };
  Index indexOf(const Eigen::Vector3f& x) const;
  std::size_t slotOf(std::uint64_t key) const;
  std::size_t markOf(std::uint64_t key) const;
  /// Number of the cell, which is made if it is not there yet.
  std::int32_t cellAt(std::uint64_t key);

  double cell_, cells_per_metre_;
  static constexpr std::size_t kMarksPerSlot = 2;
  std::vector<Slot> slots_;          // open addressing, a power of two
  std::vector<std::uint8_t> marks_;  // by hash: 1 where there may be a cell
  std::vector<Range> cells_;
  std::vector<std::uint32_t> order_;
};

}  // namespace opp
