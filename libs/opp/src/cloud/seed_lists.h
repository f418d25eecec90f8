// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace opp {

/// Seeds of samples by the cube of space that they lie in. Lists are found by a hash of the cube
/// and hold what other cubes with the same hash have, too: that lies elsewhere, and a search for
/// the cube itself would take longer than a look at it.
class SeedLists {
 public:
  /// Heads of the lists near a point, `count` of them.
  struct Heads {
    std::array<int, 8> first{};
    int count = 0;
  };

  /// Lists for about `expected` seeds that are `spacing` apart, none of them below `low`.
  SeedLists(const Eigen::Vector3f& low, double spacing, std::size_t expected)
      : origin_(low.cast<double>()), cells_per_metre_(1.0 / (kEdgeRatio * spacing)) {
    std::size_t lists = 64;
    const auto cells = static_cast<double>(expected) / (kEdgeRatio * kEdgeRatio);
    while (static_cast<double>(lists) < kListsPerCell * cells) lists *= 2;
    first_.resize(lists, -1);
  }

  /// The lists of all seeds within a spacing of `point` along each axis.
  Heads near(const Eigen::Vector3f& point) const {
    const Eigen::Array3d place = placeOf(point);
    const Cell low = floorOf(place - 1.0 / kEdgeRatio), high = floorOf(place + 1.0 / kEdgeRatio);
    const Cell step = high - low;
    Heads heads;
    // Along each axis a cube or two; without branches, which would be taken at random.
    for (unsigned corner = 0; corner < 8; ++corner) {
      const std::uint64_t x = corner & 1U, y = corner >> 1U & 1U, z = corner >> 2U;
      const bool inside = (x <= step.x()) & (y <= step.y()) & (z <= step.z());
      const int head = first_[slotOf({low.x() + x, low.y() + y, low.z() + z})];
      heads.first[static_cast<std::size_t>(heads.count)] = head;
      heads.count += inside & (head >= 0) ? 1 : 0;
    }
    return heads;
  }

  /// Makes `seed` the first of the list of the cube that holds `point`; returns the one that was.
  int push(const Eigen::Vector3f& point, int seed) {
    return std::exchange(first_[slotOf(floorOf(placeOf(point)))], seed);
  }

 private:
  /// Edge of a cube over the spacing: few to look at, few seeds in each. At least 2.
  static constexpr double kEdgeRatio = 2.5;
  static constexpr double kListsPerCell = 4.0;
  using Cell = Eigen::Array<std::uint64_t, 3, 1>;

  Eigen::Array3d placeOf(const Eigen::Vector3f& point) const {
    return (point.cast<double>() - origin_).array() * cells_per_metre_;
  }
  /// Rounds down; without SSE 4.1 std::floor is a call. `smallestCell` keeps cells in range.
  static Cell floorOf(const Eigen::Array3d& place) {
    const Eigen::Array3i truncated = place.cast<int>();
    return (truncated - (truncated.cast<double>() > place).cast<int>()).cast<std::uint64_t>();
  }
  std::size_t slotOf(const Cell& cell) const {
    // Odd numbers without a pattern in their bits.
    const std::uint64_t key = cell.x() * 0x9E3779B97F4A7C15ULL + cell.y() * 0xC2B2AE3D27D4EB4FULL +
                              cell.z() * 0x165667B19E3779F9ULL;
    return static_cast<std::size_t>(key >> 32U) & (first_.size() - 1);
  }

  Eigen::Vector3d origin_;
  double cells_per_metre_;
  std::vector<int> first_;  ///< of each list; −1: empty
};

}  // namespace opp
