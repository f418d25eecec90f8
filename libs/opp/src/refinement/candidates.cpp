// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/candidates.h"

#include "opp/geometry/constants.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace opp {
namespace {

/// Candidates are this many times as far off as outliers may be, and this much farther turned
/// [rad]: planes move by less between two searches.
constexpr double kFarther = 1.5;
constexpr double kTurned = degToRad(3.0);

void findRivals(std::size_t planes, Candidates& candidates) {
  std::vector<std::uint8_t> meet(planes * planes, 0);
  for (std::size_t i = 0; i + 1 < candidates.begin.size(); ++i) {
    for (std::uint32_t k = candidates.begin[i]; k < candidates.begin[i + 1]; ++k) {
      for (std::uint32_t l = candidates.begin[i]; l < candidates.begin[i + 1]; ++l) {
        meet[candidates.entries[k].plane * planes + candidates.entries[l].plane] = 1;
      }
    }
  }
  candidates.rivals.resize(planes);
  for (std::size_t k = 0; k < planes; ++k) {
    for (std::uint32_t l = 0; l < planes; ++l) {
      if (meet[k * planes + l] != 0) candidates.rivals[k].push_back(l);
    }
  }
}

}  // namespace

Candidates findCandidates(const SampleBlocks& blocks, const std::vector<WeightedSample>& samples,
                          const std::vector<ParallelGroup>& groups,
                          const std::vector<PlaneFit>& fits, const RefinementParams& params,
                          std::size_t stride) {
  double largest_variance = 0.0;
  for (const WeightedSample& sample : samples) {
    largest_variance = std::max(largest_variance, sample.variance);
  }
  const double least_cosine = std::cos(params.normal_gate + kTurned);
  const double reach = kFarther * params.outlier_cutoff;
  std::vector<std::pair<std::uint32_t, Candidates::Entry>> found;  // sample and entry
  Candidates candidates;
  candidates.begin.assign(samples.size() + 1, 0);
  for (std::uint32_t group = 0; group < groups.size(); ++group) {
    for (const std::size_t plane : groups[group]) {
      const PlaneFit& fit = fits[plane];
      const Eigen::Vector3d& normal = fit.plane.normal();
      const double squared_slack = fit.slack * fit.slack;
      const auto consider = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = (begin + stride - 1) / stride * stride; i < end; i += stride) {
          const WeightedSample& sample = samples[i];
          const double distance = fit.plane.signedDistance(sample.point);
          if (distance * distance > reach * reach * (sample.variance + squared_slack)) continue;
          if (!(std::abs(normal.dot(sample.normal)) >= least_cosine)) continue;
          if (!fit.reach.contains(sample.point)) continue;
          found.push_back(
              {static_cast<std::uint32_t>(i), {group, static_cast<std::uint32_t>(plane)}});
          ++candidates.begin[i + 1];
        }
      };
      blocks.visitNear(fit.plane, fit.reach.cast<float>(),
                       reach * std::sqrt(largest_variance + squared_slack), consider);
    }
  }
  std::partial_sum(candidates.begin.begin(), candidates.begin.end(), candidates.begin.begin());
  candidates.entries.resize(found.size());
  std::vector<std::uint32_t> next(candidates.begin.begin(), candidates.begin.end() - 1);
  for (const auto& [sample, entry] : found) candidates.entries[next[sample]++] = entry;
  candidates.uncontested.resize(fits.size());
  for (std::uint32_t i = 0; i < samples.size(); i += static_cast<std::uint32_t>(stride)) {
    const std::uint32_t first = candidates.begin[i];
    const bool single = candidates.begin[i + 1] == first + 1;
    (single ? candidates.uncontested[candidates.entries[first].plane] : candidates.others)
        .push_back(i);
  }
  findRivals(fits.size(), candidates);
  return candidates;
}

}  // namespace opp
