// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "dense/scan_voxels.h"

#include <tsl/robin_map.h>

#include <limits>

namespace opp::mapping {
namespace {

constexpr unsigned kCoordinateBits = 16 - kBlockShift;

bool isSet(const VoxelMask& mask, unsigned voxel) {
  return ((mask[voxel / 64] >> (voxel % 64)) & 1U) != 0;
}

void set(VoxelMask& mask, unsigned voxel) { mask[voxel / 64] |= std::uint64_t{1} << (voxel % 64); }

/// Collects updates by block. Neighbouring voxels of a ray mostly share their block.
class BlockCollector {
 public:
  BlockUpdate& at(BlockId block) {
    if (block == last_block_) return updates_[last_];
    const auto [entry, is_new] = index_.try_emplace(block, updates_.size());
    if (is_new) updates_.push_back({block, {}, {}});
    last_block_ = block;
    last_ = entry->second;
    return updates_[last_];
  }

  std::vector<BlockUpdate> take() { return std::move(updates_); }

 private:
  tsl::robin_map<BlockId, std::size_t> index_;
  std::vector<BlockUpdate> updates_;
  BlockId last_block_ = std::numeric_limits<BlockId>::max();
  std::size_t last_ = 0;
};

}  // namespace

bool isInGrid(const octomap::OcTree& grid, const Eigen::Vector3d& point) {
  // Keys have 16 bits, half of them for negative coordinates.
  constexpr double kHalfSide = 32768.0;
  return (point.array().abs() < kHalfSide * grid.getResolution()).all();
}

namespace {

/// Centres of the voxels that hold points, in the order of their first point.
std::vector<octomap::point3d> endpointVoxels(const octomap::OcTree& grid, const OccupancyScan& scan,
                                             std::size_t& passed_over) {
  BlockCollector seen;
  std::vector<octomap::point3d> ends;
  for (const Eigen::Vector3f& point : scan.points_in_map) {
    octomap::OcTreeKey key;
    if (!isInGrid(grid, point.cast<double>()) ||
        !grid.coordToKeyChecked({point.x(), point.y(), point.z()}, key)) {
      ++passed_over;
      continue;
    }
    const VoxelAddress address = addressOf(key);
    VoxelMask& mask = seen.at(address.block).occupied;
    if (isSet(mask, address.voxel)) continue;
    set(mask, address.voxel);
    ends.push_back(grid.keyToCoord(key));
  }
  return ends;
}

}  // namespace

VoxelAddress addressOf(const octomap::OcTreeKey& key) {
  BlockId block = 0;
  unsigned voxel = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    block = (block << kCoordinateBits) | BlockId(key[axis] >> kBlockShift);
    voxel = (voxel << kBlockShift) | (key[axis] & (kBlockSide - 1));
  }
  return {block, voxel};
}

octomap::OcTreeKey keyOf(BlockId block, unsigned voxel) {
  octomap::OcTreeKey key;
  for (unsigned axis = 3; axis-- > 0;) {
    const auto high = static_cast<unsigned>(block & ((1U << kCoordinateBits) - 1)) << kBlockShift;
    key[axis] = static_cast<octomap::key_type>(high | (voxel & (kBlockSide - 1)));
    block >>= kCoordinateBits;
    voxel >>= kBlockShift;
  }
  return key;
}

ScanVoxels castRays(const octomap::OcTree& grid, const OccupancyScan& scan, double max_range) {
  ScanVoxels result;
  const octomap::point3d origin(scan.origin_in_map.x(), scan.origin_in_map.y(),
                                scan.origin_in_map.z());
  octomap::OcTreeKey key;
  if (!isInGrid(grid, scan.origin_in_map.cast<double>()) || !grid.coordToKeyChecked(origin, key)) {
    result.points_passed_over = scan.points_in_map.size();
    return result;
  }
  BlockCollector collector;
  octomap::KeyRay ray;
  for (const octomap::point3d& end : endpointVoxels(grid, scan, result.points_passed_over)) {
    const bool is_hit = (end - origin).norm() <= max_range;
    const octomap::point3d ray_end =
        is_hit ? end : origin + (end - origin).normalized() * static_cast<float>(max_range);
    if (grid.computeRayKeys(origin, ray_end, ray)) {
      for (const octomap::OcTreeKey& passed : ray) {
        const VoxelAddress address = addressOf(passed);
        set(collector.at(address.block).free, address.voxel);
      }
    }
    if (is_hit && grid.coordToKeyChecked(end, key)) {
      const VoxelAddress address = addressOf(key);
      set(collector.at(address.block).occupied, address.voxel);
    }
  }
  result.blocks = collector.take();
  for (BlockUpdate& update : result.blocks) {
    for (std::size_t word = 0; word < update.free.size(); ++word) {
      update.free[word] &= ~update.occupied[word];
    }
  }
  return result;
}

}  // namespace opp::mapping
