// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop/loop_claims.h"

#include "opp/mapping/loop/keyframe_graph.h"
#include "opp/mapping/loop/match_place.h"

#include "loop/choose_keyframes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Eligible keyframes near the view of `keyframe`, as far as drift allows, but not tied to it;
/// nearest first, each at a place of its own.
std::vector<int> candidates(const MapState& map, int keyframe, const std::vector<double>& variances,
                            const std::function<bool(int)>& eligible, const MapperParams& params) {
  const LoopParams& loop = params.loop;
  const double connected = connectedVariance(map, keyframe, params);
  const Eigen::Vector3d here = map.keyframes[Index(keyframe)].viewCentre();
  using Near = std::pair<double, int>;  // distance of the views, keyframe
  std::vector<Near> near;
  for (int k = 0; k < static_cast<int>(map.keyframes.size()); ++k) {
    if (variances[Index(k)] <= connected || !eligible(k)) continue;
    const double distance = (map.keyframes[Index(k)].viewCentre() - here).norm();
    const double reach = loop.search_distance + loop.drift_gate * std::sqrt(variances[Index(k)]);
    if (distance <= reach) near.emplace_back(distance, k);
  }
  std::sort(near.begin(), near.end());
  near = distinctPlaces(near, Index(loop.max_candidates), [&](const Near& a, const Near& b) {
    return (map.keyframes[Index(a.second)].viewCentre() -
            map.keyframes[Index(b.second)].viewCentre())
               .norm() > 0.5 * loop.search_distance;
  });
  std::vector<int> keyframes;
  for (const Near& candidate : near) keyframes.push_back(candidate.second);
  return keyframes;
}

/// The keyframe's present pose, as uncertain as drift makes it relative to the candidate.
PosePrior driftedPose(const Keyframe& keyframe, double variance) {
  PosePrior prior;
  prior.map_from_body = keyframe.map_from_body;
  const double lever = leverOf(keyframe);
  Vector6d information;
  information << Eigen::Vector3d::Constant(lever * lever / variance),
      Eigen::Vector3d::Constant(1.0 / variance);
  prior.information = information.asDiagonal();
  return prior;
}

}  // namespace

double disagreement(const MapState& map, const PlaceClaim& claim) {
  const Keyframe& b = map.keyframes[Index(claim.keyframe_b)];
  const Eigen::Isometry3d claimed =
      map.keyframes[Index(claim.keyframe_a)].map_from_body * claim.keyframe_a_from_b;
  const double apart = (claimed * b.view_centre_in_body - b.viewCentre()).norm();
  return std::max(apart, leverOf(b) * rotationAngle(claimed.inverse() * b.map_from_body));
}

std::vector<PlaceClaim> loopClaims(const MapState& map, int keyframe,
                                   const std::function<bool(int)>& eligible,
                                   const MapperParams& params) {
  const std::vector<double> variances = relativeVariances(map, keyframe);
  const Keyframe& claimant = map.keyframes[Index(keyframe)];
  std::vector<PlaceClaim> claims;
  for (const int candidate : candidates(map, keyframe, variances, eligible, params)) {
    const double variance = variances[Index(candidate)];
    const auto match = matchPlace(map, candidate, claimant.features, claimant.features,
                                  driftedPose(claimant, variance), params);
    if (!match) continue;
    const PlaceClaim claim = claimOf(map, *match, map, keyframe);
    if (disagreement(map, claim) <= params.loop.drift_gate * std::sqrt(variance))
      claims.push_back(claim);
  }
  return claims;
}

}  // namespace opp::mapping
