// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/close_loops.h"

#include "opp/mapping/backend/settle_map.h"
#include "opp/mapping/loop/keyframe_graph.h"

#include "loop/loop_claims.h"

#include <algorithm>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

}  // namespace

void linkKeyframe(const std::vector<int>& matched, const Matrix6d& covariance,
                  const LoopParams& params, MapState& map) {
  const int id = static_cast<int>(map.keyframes.size()) - 1;
  const Keyframe& keyframe = map.keyframes.back();
  const double open = viewVariance(covariance, keyframe);
  for (const int other : matched) {
    const double distance = (map.keyframes[Index(other)].map_from_body.translation() -
                             keyframe.map_from_body.translation())
                                .norm();
    const double view_distance =
        (map.keyframes[Index(other)].viewCentre() - keyframe.viewCentre()).norm();
    const double drift = params.drift_ratio * std::max(distance, view_distance);
    map.links.push_back({other, id, params.step_sigma * params.step_sigma + drift * drift + open});
  }
}

void tie(const PlaceClaim& claim, const LoopParams& params, MapState& map) {
  map.factors.relative_poses.push_back(
      {claim.keyframe_a, claim.keyframe_b, claim.keyframe_a_from_b, claim.information, true});
  map.links.push_back(
      {claim.keyframe_a, claim.keyframe_b, params.step_sigma * params.step_sigma + claim.variance});
}

int acceptClaims(const std::vector<PlaceClaim>& claims, const MapperParams& params, MapState& map) {
  const MapFactors factors = map.factors;
  const auto links = map.links;
  const LandmarkMap landmarks = map.landmarks;
  std::vector<std::pair<Eigen::Isometry3d, std::vector<int>>> keyframes;
  for (const Keyframe& k : map.keyframes) {
    keyframes.emplace_back(k.map_from_body, k.landmark_of_plane);
  }
  std::vector<PlaceClaim> kept = claims;
  const Index needed = std::min(claims.size(), Index(params.loop.confirmations));
  while (!kept.empty() && kept.size() >= needed) {
    for (const PlaceClaim& claim : kept) tie(claim, params.loop, map);
    settleMap(map, 1, params);
    const auto denied = [&](const PlaceClaim& c) {
      return disagreement(map, c) > params.loop.agree_translation;
    };
    if (std::none_of(kept.begin(), kept.end(), denied)) {
      ++map.loop_closures;
      return static_cast<int>(kept.size());
    }
    kept.erase(std::remove_if(kept.begin(), kept.end(), denied), kept.end());
    map.factors = factors;
    map.links = links;
    map.landmarks = landmarks;
    for (Index k = 0; k < keyframes.size(); ++k) {
      std::tie(map.keyframes[k].map_from_body, map.keyframes[k].landmark_of_plane) = keyframes[k];
    }
  }
  return 0;
}

bool LoopCloser::close(MapState& map) {
  const int newest = static_cast<int>(map.keyframes.size()) - 1;
  claims_.forget(
      [&](const PlaceClaim& claim) { return claim.keyframe_b < newest - params_.loop.memory; });
  const auto before = [&](int k) { return k < newest; };
  for (const PlaceClaim& claim : loopClaims(map, newest, before, params_)) claims_.add(claim);
  const std::vector<PlaceClaim> agreed = claims_.agreed();
  if (agreed.empty()) return false;
  claims_.clear();
  return acceptClaims(agreed, params_, map) > 0;
}

}  // namespace opp::mapping
