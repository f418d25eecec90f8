// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/geometry/point_cloud.h"

#include "cloud/patches.h"

#include <vector>

namespace opp {

/// Patches of an organized cloud: blocks of its grid.
struct GridPatches {
  Patches patches;
  int rows = 0;  ///< of blocks
  int cols = 0;
  bool columns_wrap = false;
  std::vector<int> patch_of_block;  ///< [row * cols + col]; −1: no point in it
  std::vector<int> block_of_patch;

  /// The square window of (2·radius + 1)² blocks around a patch.
  void window(int patch, int radius, std::vector<int>& members) const;
};

/// Cuts the grid into about `target` blocks that are as wide as high in the angle they cover (a
/// spinning lidar's columns are closer than its rows). Only finite points within the sensor's range
/// count. O(points).
GridPatches makeGridPatches(const PointCloud& cloud, const SensorModel& sensor, std::size_t target);

}  // namespace opp
