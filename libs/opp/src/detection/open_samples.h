// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/detection/detect_opps.h"

#include "detection/voting_scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// Samples that lie on no plane found so far: where to look next.
class OpenSamples {
 public:
  /// All of `samples`, which must outlive this. Hypotheses within `reach` [m] and `angle` [rad] of
  /// each other are tested as one.
  OpenSamples(const std::vector<VotingSample>& samples, double reach, double angle);

  bool empty() const { return open_.empty(); }
  /// At most `count` open samples that are not marked in `taken`, at equal steps through `order`,
  /// the order of a grid: it runs cell by cell, so equal steps are even in space. Marks them.
  /// Positions in `order`.
  std::vector<std::uint32_t> take(const std::vector<std::uint32_t>& order, int count,
                                  std::vector<std::uint8_t>& taken) const;
  /// Closes the samples on the planes; returns their number. O(samples × planes).
  std::size_t close(const std::vector<PlaneHypothesis>& planes);

 private:
  const std::vector<VotingSample>& samples_;
  double reach_, angle_;
  std::vector<std::uint8_t> is_open_;  ///< 1 or 0
  std::vector<std::uint32_t> open_;    ///< ascending
};

}  // namespace opp
