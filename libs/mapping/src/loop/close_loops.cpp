// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/close_loops.h"

#include "opp/mapping/backend/settle_map.h"
#include "opp/mapping/loop/keyframe_graph.h"
#include "opp/mapping/loop/match_place.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Keyframes near the view of `keyframe`, as far as drift allows, but not tied to it; nearest
/// first, each at a place of its own.
std::vector<int> candidates(const MapState& map, int keyframe, const std::vector<double>& variances,
                            const MapperParams& params) {
  const LoopParams& loop = params.loop;
  const double connected = connectedVariance(map, keyframe, params);
  const Eigen::Vector3d here = map.keyframes[Index(keyframe)].viewCentre();
  std::vector<std::pair<double, int>> near;
  for (int k = 0; k < keyframe; ++k) {
    if (variances[Index(k)] <= connected) continue;
    const double distance = (map.keyframes[Index(k)].viewCentre() - here).norm();
    const double reach = loop.search_distance + loop.drift_gate * std::sqrt(variances[Index(k)]);
    if (distance <= reach) near.emplace_back(distance, k);
  }
  std::sort(near.begin(), near.end());
  std::vector<int> chosen;
  for (const auto& [distance, k] : near) {
    if (chosen.size() == Index(loop.max_candidates)) break;
    const Eigen::Vector3d view = map.keyframes[Index(k)].viewCentre();
    const bool new_place = std::all_of(chosen.begin(), chosen.end(), [&](int other) {
      return (map.keyframes[Index(other)].viewCentre() - view).norm() > 0.5 * loop.search_distance;
    });
    if (new_place) chosen.push_back(k);
  }
  return chosen;
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

/// How far the present poses are from a claim [m]: of what keyframe b sees, and by the turn of its
/// view. A lidar in the middle of a symmetric hall sees the same centre when turned around.
double disagreement(const MapState& map, const PlaceClaim& claim) {
  const Keyframe& b = map.keyframes[Index(claim.keyframe_b)];
  const Eigen::Isometry3d claimed =
      map.keyframes[Index(claim.keyframe_a)].map_from_body * claim.keyframe_a_from_b;
  const double apart = (claimed * b.view_centre_in_body - b.viewCentre()).norm();
  return std::max(apart, leverOf(b) * rotationAngle(claimed.inverse() * b.map_from_body));
}

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
  const std::vector<double> variances = relativeVariances(map, newest);
  const Keyframe& keyframe = map.keyframes.back();
  for (const int candidate : candidates(map, newest, variances, params_)) {
    const double variance = variances[Index(candidate)];
    const auto match = matchPlace(map, candidate, keyframe.features, keyframe.features,
                                  driftedPose(keyframe, variance), params_);
    if (!match) continue;
    const PlaceClaim claim = claimOf(map, *match, map, newest);
    if (disagreement(map, claim) > params_.loop.drift_gate * std::sqrt(variance)) continue;
    claims_.add(claim);
  }
  const std::vector<PlaceClaim> agreed = claims_.agreed();
  if (agreed.empty()) return false;
  claims_.clear();
  return acceptClaims(agreed, params_, map) > 0;
}

}  // namespace opp::mapping
