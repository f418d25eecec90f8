// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/dense/occupancy_map.h"

#include "opp/mapping/io/atomic_file.h"
#include "opp/parallel/parallel_for.h"

#include "dense/scan_voxels.h"

#include <octomap/OcTree.h>
#include <tsl/robin_map.h>

#include <algorithm>
#include <ostream>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// Scans whose voxels are in memory at once, per thread: enough that no thread waits for another.
constexpr std::size_t kScansPerThread = 8;

/// Log-odds of the voxels of a block, and which of them have been seen at all.
struct Block {
  BlockId id = 0;
  VoxelMask seen{};
  std::array<float, kBlockVoxels> log_odds{};
};

/// octomap's update of a leaf, in the same float arithmetic.
struct LeafUpdate {
  float hit, miss, min, max;

  void apply(Block& block, const BlockUpdate& update) const {
    for (std::size_t word = 0; word < update.free.size(); ++word) {
      apply(block, word, update.free[word], miss);
      apply(block, word, update.occupied[word], hit);
      block.seen[word] |= update.free[word] | update.occupied[word];
    }
  }

  void apply(Block& block, std::size_t word, std::uint64_t bits, float change) const {
    for (; bits != 0; bits &= bits - 1) {
      float& value = block.log_odds[word * 64 + static_cast<std::size_t>(__builtin_ctzll(bits))];
      value = std::clamp(value + change, min, max);
    }
  }
};

/// octomap's writeBinary without its message on stderr; leaves the tree in its most likely state.
bool writeBinaryTree(octomap::OcTree& tree, std::ostream& stream) {
  tree.toMaxLikelihood();
  tree.prune();
  stream << "# Octomap OcTree binary file\n"
            "# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
         << "id " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
         << tree.getResolution() << "\ndata\n";
  return tree.writeBinaryData(stream).good();
}

}  // namespace

struct OccupancyMap::Impl {
  explicit Impl(const OccupancyParams& parameters)
      : params(parameters), grid(makeTree(parameters)) {}

  static octomap::OcTree makeTree(const OccupancyParams& params) {
    octomap::OcTree tree(params.resolution);
    tree.setProbHit(params.hit_probability);
    tree.setProbMiss(params.miss_probability);
    tree.setClampingThresMin(params.min_probability);
    tree.setClampingThresMax(params.max_probability);
    return tree;
  }

  Block& blockAt(BlockId id);
  void insert(const std::vector<ScanVoxels>& scans, int threads);
  octomap::OcTree buildTree() const;

  OccupancyParams params;
  octomap::OcTree grid;  ///< empty; resolution and log-odds of the parameters
  tsl::robin_map<BlockId, std::size_t> index;
  std::vector<std::unique_ptr<Block>> blocks;
  std::size_t points_passed_over = 0;
};

Block& OccupancyMap::Impl::blockAt(BlockId id) {
  const auto [entry, is_new] = index.try_emplace(id, blocks.size());
  if (is_new) {
    blocks.push_back(std::make_unique<Block>());
    blocks.back()->id = id;
  }
  return *blocks[entry->second];
}

void OccupancyMap::Impl::insert(const std::vector<ScanVoxels>& scans, int threads) {
  struct Replay {
    Block* block;
    std::vector<const BlockUpdate*> updates;  // in the order of the scans
  };
  std::vector<Replay> replays;
  tsl::robin_map<BlockId, std::size_t> replay_of;
  for (const ScanVoxels& scan : scans) {
    points_passed_over += scan.points_passed_over;
    for (const BlockUpdate& update : scan.blocks) {
      const auto [entry, is_new] = replay_of.try_emplace(update.block, replays.size());
      if (is_new) replays.push_back({&blockAt(update.block), {}});
      replays[entry->second].updates.push_back(&update);
    }
  }
  const LeafUpdate leaf{grid.getProbHitLog(), grid.getProbMissLog(), grid.getClampingThresMinLog(),
                        grid.getClampingThresMaxLog()};
  parallelFor(replays.size(), threads, [&](std::size_t i) {
    for (const BlockUpdate* update : replays[i].updates) leaf.apply(*replays[i].block, *update);
  });
}

octomap::OcTree OccupancyMap::Impl::buildTree() const {
  octomap::OcTree tree = makeTree(params);
  for (const std::unique_ptr<Block>& block : blocks) {
    for (unsigned voxel = 0; voxel < kBlockVoxels; ++voxel) {
      if (((block->seen[voxel / 64] >> (voxel % 64)) & 1U) == 0) continue;
      tree.setNodeValue(keyOf(block->id, voxel), block->log_odds[voxel], true);
    }
  }
  tree.updateInnerOccupancy();
  tree.prune();
  return tree;
}

OccupancyMap::OccupancyMap(const OccupancyParams& params) {
  validate(params);
  impl_ = std::make_unique<Impl>(params);
}

OccupancyMap::~OccupancyMap() = default;
OccupancyMap::OccupancyMap(OccupancyMap&&) noexcept = default;
OccupancyMap& OccupancyMap::operator=(OccupancyMap&&) noexcept = default;

void OccupancyMap::insertScans(const std::vector<OccupancyScan>& scans, int threads) {
  const std::size_t batch = kScansPerThread * static_cast<std::size_t>(resolveThreads(threads));
  for (std::size_t begin = 0; begin < scans.size(); begin += batch) {
    std::vector<ScanVoxels> voxels(std::min(batch, scans.size() - begin));
    parallelFor(voxels.size(), threads, [&](std::size_t i) {
      voxels[i] = castRays(impl_->grid, scans[begin + i], impl_->params.max_range);
    });
    impl_->insert(voxels, threads);
  }
}

std::size_t OccupancyMap::pointsPassedOver() const { return impl_->points_passed_over; }

std::optional<double> OccupancyMap::occupancyAt(const Eigen::Vector3d& point_in_map) const {
  octomap::OcTreeKey key;
  if (!isInGrid(impl_->grid, point_in_map) ||
      !impl_->grid.coordToKeyChecked(point_in_map.x(), point_in_map.y(), point_in_map.z(), key)) {
    return std::nullopt;
  }
  const VoxelAddress address = addressOf(key);
  const auto found = impl_->index.find(address.block);
  if (found == impl_->index.end()) return std::nullopt;
  const Block& block = *impl_->blocks[found->second];
  if (((block.seen[address.voxel / 64] >> (address.voxel % 64)) & 1U) == 0) return std::nullopt;
  return octomap::probability(block.log_odds[address.voxel]);
}

void OccupancyMap::write(const std::filesystem::path& full_tree,
                         const std::filesystem::path& binary_tree) const {
  octomap::OcTree tree = impl_->buildTree();
  const auto check = [](bool written, const std::filesystem::path& path) {
    if (!written) throw std::runtime_error(path.string() + " cannot be written as an OctoMap");
  };
  // The full tree first: writing the binary one changes the tree.
  writeFileAtomically(full_tree,
                      [&](std::ostream& stream) { check(tree.write(stream), full_tree); });
  writeFileAtomically(binary_tree, [&](std::ostream& stream) {
    check(writeBinaryTree(tree, stream), binary_tree);
  });
}

OccupancyScan occupancyScan(const std::vector<Eigen::Vector3f>& points_in_body,
                            const Eigen::Vector3f& viewpoint_in_body,
                            const Eigen::Isometry3d& map_from_body) {
  OccupancyScan scan;
  scan.origin_in_map = (map_from_body * viewpoint_in_body.cast<double>()).cast<float>();
  scan.points_in_map.reserve(points_in_body.size());
  for (const Eigen::Vector3f& point : points_in_body) {
    scan.points_in_map.push_back((map_from_body * point.cast<double>()).cast<float>());
  }
  return scan;
}

}  // namespace opp::mapping
