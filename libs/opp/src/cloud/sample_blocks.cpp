// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/sample_blocks.h"

#include <algorithm>
#include <cmath>

namespace opp {
namespace {

struct Block {
  std::size_t begin = 0, end = 0;
  Eigen::AlignedBox3f box;
};

}  // namespace

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
  const auto empty = [](const Block& block) { return block.end == block.begin; };
  all.erase(std::remove_if(all.begin(), all.end(), empty), all.end());
  lows_.resize(static_cast<Eigen::Index>(all.size()), 3);
  highs_.resize(static_cast<Eigen::Index>(all.size()), 3);
  for (std::size_t k = 0; k < all.size(); ++k) {
    begins_.push_back(all[k].begin);
    lows_.row(static_cast<Eigen::Index>(k)) = all[k].box.min().transpose();
    highs_.row(static_cast<Eigen::Index>(k)) = all[k].box.max().transpose();
  }
  begins_.push_back(points.size());
}

std::vector<std::int32_t> SampleBlocks::blocksNear(const Plane& plane,
                                                   const Eigen::AlignedBox3f& box,
                                                   double distance) const {
  const float *x0 = lows_.col(0).data(), *y0 = lows_.col(1).data(), *z0 = lows_.col(2).data();
  const float *x1 = highs_.col(0).data(), *y1 = highs_.col(1).data(), *z1 = highs_.col(2).data();
  // Halves, for twice a block's centre and for half its size.
  const Eigen::Vector3f n = 0.5F * plane.normal().cast<float>(), size = n.cwiseAbs();
  const auto d = static_cast<float>(plane.d()), limit = static_cast<float>(distance);
  const Eigen::Vector3f low = box.min(), high = box.max();
  std::vector<std::int32_t> near(static_cast<std::size_t>(lows_.rows()));
  for (std::size_t k = 0; k < near.size(); ++k) {
    const float offset =
        n.x() * (x0[k] + x1[k]) + n.y() * (y0[k] + y1[k]) + n.z() * (z0[k] + z1[k]) + d;
    const float half =
        size.x() * (x1[k] - x0[k]) + size.y() * (y1[k] - y0[k]) + size.z() * (z1[k] - z0[k]);
    near[k] = (std::abs(offset) <= half + limit) & (x0[k] <= high.x()) & (x1[k] >= low.x()) &
              (y0[k] <= high.y()) & (y1[k] >= low.y()) & (z0[k] <= high.z()) & (z1[k] >= low.z());
  }
  return near;
}

}  // namespace opp
