// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/sample_blocks.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace opp {

SampleBlocks::SampleBlocks(const std::vector<Eigen::Vector3f>& points) : order_(points.size()) {
  constexpr int kSide = 16;  // blocks along each edge of the bounding box
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& point : points) box.extend(point);
  if (points.empty()) return;
  // An edge so short that its inverse is not finite counts as none.
  Eigen::Array3f scale = static_cast<float>(kSide) / box.sizes().array();
  scale = scale.isFinite().select(scale, 0.0F);
  const auto blockOf = [&](const Eigen::Vector3f& point) {
    const Eigen::Array3i cell =
        ((point - box.min()).array() * scale).min(kSide - 1.0F).max(0.0F).cast<int>();
    return static_cast<std::size_t>((cell.x() * kSide + cell.y()) * kSide + cell.z());
  };
  std::vector<Block> all(static_cast<std::size_t>(kSide) * kSide * kSide);
  for (const Eigen::Vector3f& point : points) {
    Block& block = all[blockOf(point)];
    ++block.end;
    block.box.extend(point);
  }
  std::size_t begin = 0;
  for (Block& block : all) {
    const std::size_t size = block.end;
    block.begin = block.end = begin;
    begin += size;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    order_[all[blockOf(points[i])].end++] = static_cast<std::uint32_t>(i);
  }
  std::copy_if(all.begin(), all.end(), std::back_inserter(blocks_),
               [](const Block& block) { return block.end > block.begin; });
}

}  // namespace opp
