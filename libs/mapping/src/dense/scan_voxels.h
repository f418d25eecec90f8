// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/dense/occupancy_map.h"

#include <octomap/OcTree.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp::mapping {

/// A block is a cube of 8³ voxels: a subtree of an octree, three levels high.
inline constexpr unsigned kBlockShift = 3;
inline constexpr unsigned kBlockSide = 1U << kBlockShift;
inline constexpr std::size_t kBlockVoxels = std::size_t{kBlockSide} * kBlockSide * kBlockSide;
using BlockId = std::uint64_t;
/// One bit per voxel of a block.
using VoxelMask = std::array<std::uint64_t, kBlockVoxels / 64>;

/// Where a voxel is: its block, and its number inside of it.
struct VoxelAddress {
  BlockId block;
  unsigned voxel;
};
VoxelAddress addressOf(const octomap::OcTreeKey& key);
octomap::OcTreeKey keyOf(BlockId block, unsigned voxel);

/// What one scan says about the voxels of one block. No voxel is both.
struct BlockUpdate {
  BlockId block = 0;
  VoxelMask free{};
  VoxelMask occupied{};
};

struct ScanVoxels {
  std::vector<BlockUpdate> blocks;  ///< each block once, in the order in which rays met them
  std::size_t points_passed_over = 0;
};

/// Whether the grid has a voxel for a point; false if it is not finite. Octomap itself converts
/// coordinates to `int` first, which is undefined far outside.
bool isInGrid(const octomap::OcTree& grid, const Eigen::Vector3d& point);

/// The voxels that octomap's computeDiscreteUpdate finds for this scan: each voxel with a point is
/// occupied and is the end of one ray; voxels on the way are free unless occupied.
/// `grid`: gives resolution and bounds only; its contents are not used.
ScanVoxels castRays(const octomap::OcTree& grid, const OccupancyScan& scan, double max_range);

}  // namespace opp::mapping
