// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/refinement/refinement_params.h"

#include "cloud/sample_blocks.h"
#include "refinement/sample_assignment.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// Planes that share one normal.
using ParallelGroup = std::vector<std::size_t>;

/// Planes that each sample may be given to while the planes move little.
struct Candidates {
  struct Entry {
    std::uint32_t group = 0;  ///< rank
    std::uint32_t plane = 0;
  };
  std::vector<std::uint32_t> begin;  ///< of each sample's entries, and their end
  std::vector<Entry> entries;        ///< of a sample: those of the first group first
  /// Per plane: the samples that can belong to no other plane, ascending.
  std::vector<std::vector<std::uint32_t>> uncontested;
  std::vector<std::uint32_t> contested;  ///< samples with several candidates, ascending
  /// Per plane: the planes that share a candidate sample with it, itself included.
  std::vector<std::vector<std::uint32_t>> rivals;
};

/// Searches the samples of a scan, one array per number, so that the loop over them vectorizes. In
/// single precision: what it rounds is far below the margins.
class CandidateSearch {
 public:
  /// `blocks` must outlive this; `samples` are in their order.
  CandidateSearch(const SampleBlocks& blocks, const std::vector<WeightedSample>& samples);

  /// Candidates of every `stride`-th sample, which the others have none: planes within whose reach
  /// it lies, not much farther off than outliers are.
  Candidates find(const std::vector<ParallelGroup>& groups, const std::vector<PlaneFit>& fits,
                  const RefinementParams& params, std::size_t stride) const;

 private:
  /// Marks the samples near the plane (1, not near: 0) and calls visit(begin, end) for the
  /// stretches that were looked at.
  template <typename Visit>
  void markNear(const PlaneFit& fit, const RefinementParams& params,
                std::vector<std::int32_t>& near, const Visit& visit) const;

  const SampleBlocks& blocks_;
  Eigen::ArrayX3f points_, normals_;
  Eigen::ArrayXf variances_;
  double largest_variance_ = 0.0;
};

}  // namespace opp
