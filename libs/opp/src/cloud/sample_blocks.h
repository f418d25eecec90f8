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

  /// visit(begin, end), stretches of `order()` that hold the blocks that reach into `box` and
  /// within `distance` [m] of the plane. Stretches ascend; blocks that follow each other are one.
  template <typename Visit>
  void visitNear(const Plane& plane, const Eigen::AlignedBox3f& box, double distance,
                 const Visit& visit) const {
    const std::vector<std::int32_t> near = blocksNear(plane, box, distance);
    std::size_t block = 0;
    while (block < near.size()) {
      const std::size_t first = block;
      while (block < near.size() && near[block] != 0) ++block;
      if (block > first) visit(begins_[first], begins_[block]);
      while (block < near.size() && near[block] == 0) ++block;
    }
  }

 private:
  /// 1 for each block that reaches into `box` and within `distance` of the plane, else 0.
  std::vector<std::int32_t> blocksNear(const Plane& plane, const Eigen::AlignedBox3f& box,
                                       double distance) const;

  std::vector<std::uint32_t> order_;
  // Blocks that are not empty, one array per number, so that the loop over them vectorizes.
  std::vector<std::size_t> begins_;  ///< and the end of the last
  Eigen::ArrayX3f lows_, highs_;     ///< corners of their boxes
};

}  // namespace opp
