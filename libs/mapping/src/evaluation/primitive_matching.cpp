// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/primitive_matching.h"

#include "opp/mapping/evaluation/assignment.h"

#include <algorithm>
#include <limits>

namespace opp::mapping {
namespace {

/// Of each estimated element's candidates; infinite if it has none.
std::vector<double> leastCosts(std::size_t est_count,
                               const std::vector<PrimitiveCandidate>& candidates) {
  std::vector<double> costs(est_count, std::numeric_limits<double>::infinity());
  for (const PrimitiveCandidate& c : candidates) costs[c.est] = std::min(costs[c.est], c.cost);
  return costs;
}

}  // namespace

PrimitiveMatching matchPrimitives(
    const std::vector<double>& gt_sizes, std::size_t est_count,
    const std::vector<PrimitiveCandidate>& candidates,
    const std::vector<PrimitiveCandidate>& barely_seen,
    const std::function<bool(std::size_t, std::size_t)>& same_in_truth) {
  const std::size_t gt_count = gt_sizes.size();
  std::vector<AssignmentCandidate> edges;
  for (const PrimitiveCandidate& c : candidates) edges.push_back({c.gt, c.est, c.cost});
  const std::vector<int> chosen = assignOneToOne(gt_count, est_count, edges);
  PrimitiveMatching matching;
  matching.gt_of_est.assign(est_count, -1);
  PrimitiveTally& tally = matching.tally;
  tally.gt = gt_count;
  tally.est = est_count;
  std::vector<bool> found(gt_count, false);
  for (std::size_t g = 0; g < gt_count; ++g) {
    if (chosen[g] < 0) continue;
    const PrimitiveCandidate& c = candidates[static_cast<std::size_t>(chosen[g])];
    found[g] = true;
    matching.gt_of_est[c.est] = static_cast<int>(g);
    tally.angles.push_back(c.angle);
    tally.distances.push_back(c.distance);
  }
  tally.est_correct = tally.angles.size();
  for (const PrimitiveCandidate& c : candidates) {
    const int other = matching.gt_of_est[c.est];
    if (chosen[c.gt] >= 0 || other < 0) continue;
    if (same_in_truth(c.gt, static_cast<std::size_t>(other))) found[c.gt] = true;
  }
  for (std::size_t g = 0; g < gt_count; ++g) {
    tally.gt_found += found[g];
    tally.gt_size += gt_sizes[g];
    if (found[g]) tally.gt_size_found += gt_sizes[g];
  }
  // What is rather the same as a true element is wrong if that was found already: a duplicate.
  const std::vector<double> as_true = leastCosts(est_count, candidates);
  const std::vector<double> as_barely_seen = leastCosts(est_count, barely_seen);
  for (std::size_t e = 0; e < est_count; ++e)
    tally.est_neutral += matching.gt_of_est[e] < 0 && as_barely_seen[e] < as_true[e];
  return matching;
}

}  // namespace opp::mapping
