// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/match_place.h"

#include "opp/mapping/frontend/build_local_map.h"
#include "opp/mapping/loop/keyframe_graph.h"
#include "opp/mapping/loop/place.h"
#include "opp/mapping/registration/align_globally.h"

#include "registration/observability.h"

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

const Keyframe& keyframeOf(const MapState& map, int id) {
  return map.keyframes[static_cast<std::size_t>(id)];
}

PlaceMatch describe(const MapState& map, int keyframe, const MatchResult& match) {
  const Eigen::Isometry3d& map_from_keyframe = keyframeOf(map, keyframe).map_from_body;
  PlaceMatch result;
  result.keyframe = keyframe;
  result.keyframe_from_body = normalized(map_from_keyframe.inverse() * match.map_from_body);
  result.information = informationIn(map_from_keyframe.linear(), match.point_information);
  result.overlap = match.overlap;
  return result;
}

/// Whether too much of scan and place stands where the other looked through.
bool contradicts(const Place& place, const ScanFeatures& scan, const Keyframe& keyframe,
                 const MatchResult& match, const MapperParams& params) {
  const GlobalAlignment judged =
      judgePose(place.input(), scan, keyframe.map_from_body.inverse() * match.map_from_body,
                params.primitives.sensor, params.global_alignment);
  return !judged.hypotheses.empty() &&
         judged.hypotheses.front().conflict > params.global_alignment.max_conflict;
}

/// Whether a scan fixes its pose at a place by itself.
bool isFixed(double variance, const MapperParams& params) {
  constexpr double kSigmas = 3.0;
  return kSigmas * std::sqrt(variance) <= params.loop.agree_translation;
}

/// An aligned scan, registered from there. That is more precise, but the scan alone may look past
/// the place and slide along what it shares with it: then the alignment stands, which has weighed
/// all that is known.
PlaceMatch refined(const MapState& map, int keyframe, const ScanFeatures& scan,
                   const LocalMap& local, const GlobalAlignment& alignment,
                   const MapperParams& params) {
  // A start without weight: the alignment saw the same scan, so its information must not count
  // twice.
  PosePrior start;
  start.map_from_body = keyframeOf(map, keyframe).map_from_body * alignment.target_from_source;
  const MatchResult match = matchScan(scan, local, start, params.registration);
  PlaceMatch result = describe(map, keyframe, match);
  const Matrix6d information = alignment.covariance.inverse();
  const Vector6d moved = difference(alignment.target_from_source, result.keyframe_from_body);
  const double own_variance =
      viewVariance(covarianceOf(match.information), keyframeOf(map, keyframe));
  if (match.overlap < params.global_alignment.min_overlap || !isFixed(own_variance, params) ||
      moved.dot(information * moved) > kPossible) {
    result.keyframe_from_body = alignment.target_from_source;
    result.information = information;
    result.overlap = alignment.overlap;
  }
  result.clarity = alignment.clarity;
  result.variance = viewVariance(alignment.covariance, keyframeOf(map, keyframe));
  return result;
}

}  // namespace

double connectedVariance(const MapState& map, int keyframe, const MapperParams& params) {
  const double voxel = params.registration.surfel_size_ratio *
                       keyframeOf(map, keyframe).features.cloud_in_body.spacing;
  return std::pow(params.loop.connected_ratio * voxel, 2);
}

std::vector<int> connectedViews(const MapState& map, int keyframe, int count,
                                const MapperParams& params) {
  return nearestViews(map, keyframe, relativeVariances(map, keyframe),
                      connectedVariance(map, keyframe, params), count);
}

std::optional<PlaceMatch> matchPlace(const MapState& map, int keyframe, const ScanFeatures& scan,
                                     const AlignmentInput& surroundings,
                                     const std::optional<PosePrior>& expected,
                                     const MapperParams& params) {
  const std::vector<int> place = connectedViews(map, keyframe, params.loop.place_keyframes, params);
  const Place merged = placeOf(map, keyframe, place, params);
  std::optional<LocalMap> local;  // most candidates need none
  if (expected) {
    local = localMapOf(map, place, params);
    const MatchResult match = matchScan(scan, *local, *expected, params.registration);
    if (match.overlap >= params.loop.min_overlap &&
        !contradicts(merged, scan, keyframeOf(map, keyframe), match, params)) {
      PlaceMatch result = describe(map, keyframe, match);
      result.variance = viewVariance(covarianceOf(match.information), keyframeOf(map, keyframe));
      // What the scan leaves open is still where it was expected, which proves nothing.
      if (!isFixed(result.variance, params)) return std::nullopt;
      return result;
    }
  }
  const GlobalAlignment alignment = alignGlobally(
      merged.input(), surroundings, params.primitives.sensor, params.global_alignment);
  if (alignment.outcome != AlignmentOutcome::kAligned) return std::nullopt;
  if (!local) local = localMapOf(map, place, params);
  return refined(map, keyframe, scan, *local, alignment, params);
}

PlaceClaim claimOf(const MapState& map_a, const PlaceMatch& match, const MapState& map_b,
                   int keyframe_b) {
  const Keyframe& claimant = keyframeOf(map_b, keyframe_b);
  PlaceClaim claim;
  claim.keyframe_a = match.keyframe;
  claim.keyframe_b = keyframe_b;
  claim.keyframe_a_from_b = match.keyframe_from_body;
  claim.information = match.information;
  claim.variance = match.variance;
  claim.claimant = claimant.features.id();
  relate(map_a, map_b, claim);
  return claim;
}

void relate(const MapState& map_a, const MapState& map_b, PlaceClaim& claim) {
  const Keyframe& b = keyframeOf(map_b, claim.keyframe_b);
  claim.map_a_from_map_b = keyframeOf(map_a, claim.keyframe_a).map_from_body *
                           claim.keyframe_a_from_b * b.map_from_body.inverse();
  claim.place_in_map_b = b.viewCentre();
}

}  // namespace opp::mapping
