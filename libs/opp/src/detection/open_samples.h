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
  /// Those of `samples`, which must outlive this, for which `is_open` is 1 and not 0. Hypotheses of
  /// one plane, with normals within `angle` [rad], are tested as one.
  OpenSamples(const std::vector<VotingSample>& samples, std::vector<std::uint8_t> is_open,
              double angle);

  bool empty() const { return open_.empty(); }
  /// Per sample: 1 if it is open, else 0.
  const std::vector<std::uint8_t>& flags() const { return is_open_; }
  /// Opens again what planes with fewer than `least` samples have closed.
  void reopen(int least);
  /// At most `count` open samples that are not marked in `taken`, at equal steps through `order`,
  /// the order of a grid: it runs cell by cell, so equal steps are even in space. Marks them.
  /// Positions in `order`.
  std::vector<std::uint32_t> take(const std::vector<std::uint32_t>& order, int count,
                                  std::vector<std::uint8_t>& taken) const;
  /// Closes the samples on the planes, within the reach of the hypotheses; returns their number.
  /// O(samples × planes).
  std::size_t close(const std::vector<PlaneHypothesis>& planes);

 private:
  const std::vector<VotingSample>& samples_;
  double angle_;
  std::vector<std::uint8_t> is_open_;  ///< 1 or 0
  std::vector<std::uint32_t> open_;    ///< ascending
  std::vector<std::int32_t> closer_;   ///< plane that closed each sample, index into closed_
  std::vector<int> closed_;            ///< samples that each plane has closed
};

}  // namespace opp
