// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/claim_pool.h"

#include <algorithm>
#include <set>

namespace opp::mapping {

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

std::vector<PlaceClaim> ClaimPool::agreed() const {
  std::vector<PlaceClaim> best;
  std::size_t most = 0;
  const PlaceClaim* centre = nullptr;
  const auto keyframes = [&](const std::vector<PlaceClaim>& claims) {
    std::set<int> ids;
    std::size_t certain = 0;
    for (const PlaceClaim& c : claims) {
      ids.insert(c.keyframe_b);
      if (c.clarity >= params_.certain_clarity)
        certain = static_cast<std::size_t>(params_.confirmations);
    }
    return std::max(ids.size(), certain);
  };
  for (const PlaceClaim& claim : claims_) {
    std::vector<PlaceClaim> group;
    std::copy_if(claims_.begin(), claims_.end(), std::back_inserter(group),
                 [&](const PlaceClaim& other) { return agree(claim, other); });
    if (keyframes(group) <= most) continue;
    most = keyframes(group);
    best = std::move(group);
    centre = &claim;
  }
  if (most < static_cast<std::size_t>(params_.confirmations)) return {};
  std::vector<PlaceClaim> rivals;
  std::copy_if(claims_.begin(), claims_.end(), std::back_inserter(rivals),
               [&](const PlaceClaim& other) { return !agree(*centre, other); });
  if (static_cast<double>(most) < params_.rival_ratio * static_cast<double>(keyframes(rivals)))
    return {};
  return best;
}

}  // namespace opp::mapping
