// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/refinement/refinement_params.h"

#include "cloud/sample_blocks.h"
#include "refinement/sample_assignment.h"

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
  std::vector<std::uint32_t> others;  ///< samples with no candidate, or several; ascending
  /// Per plane: the planes that share a candidate sample with it, itself included.
  std::vector<std::vector<std::uint32_t>> rivals;
};

/// Candidates of every `stride`-th sample, which the others have none: planes within whose reach it
/// lies, not much farther off than outliers are. `samples` are in the order of `blocks`.
Candidates findCandidates(const SampleBlocks& blocks, const std::vector<WeightedSample>& samples,
                          const std::vector<ParallelGroup>& groups,
                          const std::vector<PlaneFit>& fits, const RefinementParams& params,
                          std::size_t stride);

}  // namespace opp
