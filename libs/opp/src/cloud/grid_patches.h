// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/geometry/point_cloud.h"

#include "cloud/patches.h"

#include <cstddef>
#include <vector>

namespace opp {

/// Patches of an organized cloud: blocks of its grid.
struct GridPatches {
  Patches patches;
  int rows = 0;  ///< of blocks
  int cols = 0;
  int block_rows = 1;  ///< of a block, in pixels
  int block_cols = 1;
  bool columns_wrap = false;
  /// [row * cols + col]; −1: no point in it, or too far away
  std::vector<int> patch_of_block;
  std::vector<int> block_of_patch;
};

/// Cuts the grid into about `target` blocks that are as wide as high in the angle they cover (a
/// spinning lidar's columns are closer than its rows). Only finite points within the sensor's range
/// count. O(points).
GridPatches makeGridPatches(const PointCloud& cloud, const SensorModel& sensor, std::size_t target);

/// Square windows of (2·radius + 1)² blocks. Their sums come from a summed-area table (Crow 1984):
/// constant time for any radius up to `max_radius`.
class GridWindows final : public PatchWindows {
 public:
  /// `grid` must outlive this. O(blocks).
  GridWindows(const GridPatches& grid, int max_radius);

  WindowSums sums(int patch, int radius) override;
  void members(int patch, int radius, std::vector<int>& members) override;
  /// The window's centre, and the patches at its corners and the middles of its sides.
  void shifted(int patch, int radius, std::vector<int>& centers) override;

 private:
  /// Radius along a row: a window as wide as the whole turn must not meet itself.
  int reach(int radius) const;
  /// Patch of a block, across the seam of a turn; −1: none.
  int patchAt(int row, int col) const;
  /// Sums over all blocks above `row` and left of `col`, both counted with the margin.
  WindowSums& area(int row, int col) {
    return areas_[static_cast<std::size_t>(row) * static_cast<std::size_t>(stride_) +
                  static_cast<std::size_t>(col)];
  }

  const GridPatches& grid_;
  int margin_;  ///< columns repeated on both sides of a grid that wraps
  int stride_;
  std::vector<WindowSums> areas_;
};

}  // namespace opp
