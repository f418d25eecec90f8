// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detection/gather_hypotheses.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opp {
namespace {

bool samePlane(const PlaneHypothesis& a, const PlaneHypothesis& b, double cosine) {
  const double reach = std::min(a.resolution, b.resolution);
  return std::abs(a.plane.normal().dot(b.plane.normal())) > cosine &&
         std::abs(a.plane.signedDistance(b.anchor)) < reach &&
         std::abs(b.plane.signedDistance(a.anchor)) < reach;
}

Eigen::AlignedBox3f boxOf(const PlaneHypothesis& hypothesis) {
  const Eigen::Vector3f anchor = hypothesis.anchor.cast<float>();
  const Eigen::Vector3f reach = Eigen::Vector3f::Constant(static_cast<float>(hypothesis.reach));
  return {anchor - reach, anchor + reach};
}

}  // namespace

GatheredHypotheses gatherHypotheses(const std::vector<PlaneHypothesis>& hypotheses, double angle) {
  std::vector<std::size_t> order(hypotheses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return hypotheses[a].votes > hypotheses[b].votes;
  });
  const double cosine = std::cos(angle);
  GatheredHypotheses gathered;
  gathered.leader_of.resize(hypotheses.size());
  for (const std::size_t h : order) {
    const auto leader =
        std::find_if(gathered.leaders.begin(), gathered.leaders.end(), [&](std::size_t candidate) {
          return samePlane(hypotheses[candidate], hypotheses[h], cosine);
        });
    const auto slot = static_cast<std::size_t>(leader - gathered.leaders.begin());
    gathered.leader_of[h] = leader == gathered.leaders.end() ? h : *leader;
    if (slot == gathered.leaders.size()) {
      gathered.leaders.push_back(h);
      gathered.boxes.emplace_back();
    }
    gathered.boxes[slot].extend(boxOf(hypotheses[h]));
  }
  return gathered;
}

}  // namespace opp
