// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
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
  double overlap = 0.0;                     ///< see MatchResult
  double clarity = 0.0;  ///< see GlobalAlignment; 0 where the expected pose was right
};

/// The keyframes that make up the place of one keyframe: itself and those that look there and whose
/// relative poses are well known; at most `LoopParams::place_keyframes`, ascending.
std::vector<int> placeAround(const MapState& map, int keyframe, const MapperParams& params);

/// Looks for a scan at the place of one keyframe. With an `expected` pose of the body in the map
/// the scan is registered from there first; if that fails, or without it, the scan's `surroundings`
/// (in its body frame: the scan itself, or more that is known of where it stands) are aligned with
/// the place with no guess. Nothing unless enough of the scan agrees (`LoopParams::min_overlap`) at
/// one clear pose.
std::optional<PlaceMatch> matchPlace(const MapState& map, int keyframe, const ScanFeatures& scan,
                                     const AlignmentInput& surroundings,
                                     const std::optional<PosePrior>& expected,
                                     const MapperParams& params);

}  // namespace opp::mapping
