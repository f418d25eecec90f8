// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/claim_pool.h"

#include "registration/observability.h"

#include <algorithm>
#include <set>
#include <utility>

namespace opp::mapping {
PlaceClaim seenFromOther(const PlaceClaim& claim) {
  PlaceClaim result = claim;
  std::swap(result.keyframe_a, result.keyframe_b);
  result.keyframe_a_from_b = claim.keyframe_a_from_b.inverse();
  // (ω, v) of a pose makes (−Rᵀω, −Rᵀ(v − ω × t)) of its inverse, see `retract`.
  const Eigen::Isometry3d& b_from_a = result.keyframe_a_from_b;
  const Matrix6d back = -turned(b_from_a.linear().transpose()) * movedBy(-b_from_a.translation());
  result.information = back.transpose() * claim.information * back;
  result.map_a_from_map_b = claim.map_a_from_map_b.inverse();
  result.place_in_map_b = claim.map_a_from_map_b * claim.place_in_map_b;
  result.b_looked = !claim.b_looked;
  return result;
}

std::size_t claimantsOf(const std::vector<PlaceClaim>& claims) {
  std::set<ScanId> of_a, of_b;
  for (const PlaceClaim& c : claims) (c.b_looked ? of_b : of_a).insert(c.claimant);
  return std::max(of_a.size(), of_b.size());
}

bool ClaimPool::agree(const PlaceClaim& x, const PlaceClaim& y) const {
  if (rotationAngle(x.map_a_from_map_b.inverse() * y.map_a_from_map_b) > params_.agree_rotation)
    return false;
  // At both places: a small turn moves what is far from the frame's origin by a lot.
  for (const Eigen::Vector3d& place : {x.place_in_map_b, y.place_in_map_b}) {
    const double apart = (x.map_a_from_map_b * place - y.map_a_from_map_b * place).norm();
    if (apart > params_.agree_translation) return false;
  }
  return true;
}

std::vector<PlaceClaim> ClaimPool::groupOf(const PlaceClaim& claim,
                                           const std::vector<PlaceClaim>& claims) const {
  std::vector<PlaceClaim> group{claim};
  std::copy_if(claims.begin(), claims.end(), std::back_inserter(group),
               [&](const PlaceClaim& other) { return &other != &claim && agree(claim, other); });
  return group;
}

std::vector<PlaceClaim> ClaimPool::confirmed() const {
  std::vector<PlaceClaim> result;
  std::copy_if(
      claims_.begin(), claims_.end(), std::back_inserter(result), [&](const PlaceClaim& claim) {
        return claimantsOf(groupOf(claim, claims_)) >= static_cast<std::size_t>(confirmations_);
      });
  return result;
}

std::vector<PlaceClaim> ClaimPool::agreed() const {
  std::vector<PlaceClaim> best = largestGroup(claims_);
  const std::size_t most = claimantsOf(best);
  const bool certain =
      one_may_do_ && std::any_of(best.begin(), best.end(), [&](const PlaceClaim& c) {
        return c.clarity >= params_.certain_clarity;
      });
  if (!certain && most < static_cast<std::size_t>(confirmations_)) return {};
  std::vector<PlaceClaim> others;
  std::copy_if(claims_.begin(), claims_.end(), std::back_inserter(others),
               [&](const PlaceClaim& other) { return !agree(best.front(), other); });
  const std::size_t rivals = claimantsOf(largestGroup(others));
  if (static_cast<double>(most) < params_.rival_ratio * static_cast<double>(rivals)) return {};
  return best;
}

/// The claim that most keyframes agree with and these, in order of arrival but for the first.
std::vector<PlaceClaim> ClaimPool::largestGroup(const std::vector<PlaceClaim>& claims) const {
  std::vector<PlaceClaim> largest;
  std::size_t most = 0;
  for (const PlaceClaim& claim : claims) {
    std::vector<PlaceClaim> group = groupOf(claim, claims);
    const std::size_t claimants = claimantsOf(group);
    if (claimants <= most) continue;
    most = claimants;
    largest = std::move(group);
  }
  return largest;
}

}  // namespace opp::mapping
