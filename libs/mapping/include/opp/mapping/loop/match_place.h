// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/loop/claim_pool.h"
#include "opp/mapping/registration/alignment_input.h"
#include "opp/mapping/registration/match_scan.h"

#include <optional>
#include <vector>

namespace opp::mapping {

/// A scan found at a place of a map.
struct PlaceMatch {
  int keyframe = 0;  ///< of the map, where the place is
  Eigen::Isometry3d keyframe_from_body = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of (ω, v) in the keyframe's frame, see `retract`
  /// Of what is seen from there, by the scan (and its surroundings) alone, see `viewVariance` [m²].
  double variance = 0.0;
  double overlap = 0.0;  ///< see MatchResult
  double clarity = 0.0;  ///< see GlobalAlignment; 0 where the expected pose was right
};

/// Largest variance [m²] of a keyframe's position relative to `keyframe` at which the surfaces of
/// both are taken for one without further proof (`LoopParams::connected_ratio`).
double connectedVariance(const MapState& map, int keyframe, const MapperParams& params);

/// At most `count` keyframes, ascending: the given one and those that look where it does and whose
/// poses relative to it are known well enough (`connectedVariance`).
std::vector<int> connectedViews(const MapState& map, int keyframe, int count,
                                const MapperParams& params);

/// Looks for a scan at the place of one keyframe. With an `expected` pose of the body in the map
/// the scan is registered from there first, which counts only if the scan itself fixes its pose
/// within `LoopParams::agree_translation`; if that fails, or without it, the scan's `surroundings`
/// (in its body frame: the scan itself, or more that is known of where it stands) are aligned with
/// the place with no guess. Nothing unless enough of the scan agrees (`LoopParams::min_overlap`) at
/// one clear pose.
std::optional<PlaceMatch> matchPlace(const MapState& map, int keyframe, const ScanFeatures& scan,
                                     const AlignmentInput& surroundings,
                                     const std::optional<PosePrior>& expected,
                                     const MapperParams& params);

/// What a match of keyframe `keyframe_b` of `map_b` in `map_a` claims about the two maps (or the
/// same map before and after drift).
PlaceClaim claimOf(const MapState& map_a, const PlaceMatch& match, const MapState& map_b,
                   int keyframe_b);

/// Sets what follows from a claim for the frames of the two maps, as their keyframes stand now.
void relate(const MapState& map_a, const MapState& map_b, PlaceClaim& claim);

}  // namespace opp::mapping
