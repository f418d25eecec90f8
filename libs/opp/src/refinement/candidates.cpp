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

/// Lists the samples that need no choice between planes apart from the others.
void sortByContest(std::size_t samples, std::size_t stride, std::size_t planes,
                   Candidates& candidates) {
  candidates.uncontested.resize(planes);
  for (std::size_t i = 0; i < samples; i += stride) {
    const std::uint32_t first = candidates.begin[i];
    const std::uint32_t count = candidates.begin[i + 1] - first;
    if (count == 0) continue;
    (count == 1 ? candidates.uncontested[candidates.entries[first].plane] : candidates.contested)
        .push_back(static_cast<std::uint32_t>(i));
  }
}

}  // namespace

CandidateSearch::CandidateSearch(const SampleBlocks& blocks,
                                 const std::vector<WeightedSample>& samples)
    : blocks_(blocks) {
  const auto count = static_cast<Eigen::Index>(samples.size());
  points_.resize(count, 3);
  normals_.resize(count, 3);
  variances_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const WeightedSample& sample = samples[static_cast<std::size_t>(i)];
    points_.row(i) = sample.point.cast<float>().transpose();
    normals_.row(i) = sample.normal.cast<float>().transpose();
    variances_[i] = static_cast<float>(sample.variance);
    largest_variance_ = std::max(largest_variance_, sample.variance);
  }
}

template <typename Visit>
void CandidateSearch::markNear(const PlaneFit& fit, const RefinementParams& params,
                               std::vector<std::int32_t>& near, const Visit& visit) const {
  const float *x = points_.col(0).data(), *y = points_.col(1).data(), *z = points_.col(2).data();
  const float *nx = normals_.col(0).data(), *ny = normals_.col(1).data(),
              *nz = normals_.col(2).data();
  const float* variances = variances_.data();
  std::int32_t* marks = near.data();
  const Eigen::Vector4f coefficients = fit.plane.coefficients().cast<float>();
  const float a = coefficients[0], b = coefficients[1], c = coefficients[2], d = coefficients[3];
  const Eigen::AlignedBox3f box = fit.reach.cast<float>();
  const Eigen::Vector3f low = box.min(), high = box.max();
  const double reach = kFarther * params.outlier_cutoff;
  const auto squared_reach = static_cast<float>(reach * reach);
  const auto squared_slack = static_cast<float>(fit.slack * fit.slack);
  const auto least_cosine = static_cast<float>(std::cos(params.normal_gate + kTurned));
  const double farthest = reach * std::sqrt(largest_variance_ + fit.slack * fit.slack);
  blocks_.visitNear(fit.plane, box, farthest, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float distance = a * x[i] + b * y[i] + c * z[i] + d;
      const float cosine = std::abs(a * nx[i] + b * ny[i] + c * nz[i]);
      const bool inside = (x[i] >= low.x()) & (x[i] <= high.x()) & (y[i] >= low.y()) &
                          (y[i] <= high.y()) & (z[i] >= low.z()) & (z[i] <= high.z());
      marks[i] = inside & (cosine >= least_cosine) &
                 (distance * distance <= squared_reach * (variances[i] + squared_slack));
    }
    visit(begin, end);
  });
}

Candidates CandidateSearch::find(const std::vector<ParallelGroup>& groups,
                                 const std::vector<PlaneFit>& fits, const RefinementParams& params,
                                 std::size_t stride) const {
  const auto samples = static_cast<std::size_t>(variances_.size());
  std::vector<std::uint32_t> found;  // samples near a plane, one plane after another
  std::vector<std::pair<Candidates::Entry, std::size_t>> planes;  // and where in `found` its end is
  std::vector<std::int32_t> near(samples);
  Candidates candidates;
  candidates.begin.assign(samples + 1, 0);
  for (std::uint32_t group = 0; group < groups.size(); ++group) {
    for (const std::size_t plane : groups[group]) {
      const Candidates::Entry entry{group, static_cast<std::uint32_t>(plane)};
      markNear(fits[plane], params, near, [&](std::size_t begin, std::size_t end) {
        // Without a branch, which would be taken at random.
        std::size_t count = found.size();
        found.resize(count + (end - begin));
        for (std::size_t i = (begin + stride - 1) / stride * stride; i < end; i += stride) {
          found[count] = static_cast<std::uint32_t>(i);
          count += static_cast<std::size_t>(near[i]);
          candidates.begin[i + 1] += static_cast<std::uint32_t>(near[i]);
        }
        found.resize(count);
      });
      planes.emplace_back(entry, found.size());
    }
  }
  std::partial_sum(candidates.begin.begin(), candidates.begin.end(), candidates.begin.begin());
  candidates.entries.resize(found.size());
  std::vector<std::uint32_t> next(candidates.begin.begin(), candidates.begin.end() - 1);
  std::size_t at = 0;
  for (const auto& [entry, end] : planes) {
    for (; at < end; ++at) candidates.entries[next[found[at]]++] = entry;
  }
  sortByContest(samples, stride, fits.size(), candidates);
  findRivals(fits.size(), candidates);
  return candidates;
}

}  // namespace opp
