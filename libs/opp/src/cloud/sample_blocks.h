// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// Samples sorted into blocks of space, so that what lies near a plane is found without a look at
/// all of them.
class SampleBlocks {
 public:
  /// `points` finite. O(size).
  explicit SampleBlocks(const std::vector<Eigen::Vector3f>& points);

  /// Indices of the samples, block by block.
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// visit(begin, end), a stretch of `order()`, for each block that reaches into `box` and within
  /// `distance` [m] of the plane. Stretches ascend.
  template <typename Visit>
  void visitNear(const Plane& plane, const Eigen::AlignedBox3f& box, double distance,
                 const Visit& visit) const {
    const Eigen::Vector3f normal = plane.normal().cast<float>();
    const auto d = static_cast<float>(plane.d()), limit = static_cast<float>(distance);
    for (const Block& block : blocks_) {
      if (!block.box.intersects(box)) continue;
      const float half = 0.5F * normal.cwiseAbs().dot(block.box.sizes());
      if (!(std::abs(normal.dot(block.box.center()) + d) <= half + limit)) continue;
      visit(block.begin, block.end);
    }
  }

 private:
  struct Block {
    std::size_t begin = 0, end = 0;
    Eigen::AlignedBox3f box;
  };
  std::vector<std::uint32_t> order_;
  std::vector<Block> blocks_;  ///< none is empty
};

}  // namespace opp
