// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/registration/match_scan.h"

#include <optional>

namespace opp::mapping {

/// A scan found at a place of a map.
struct PlaceMatch {
  int keyframe = 0;  ///< of the map, where the place is
  Eigen::Isometry3d keyframe_from_body = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of (ω, v) in the keyframe's frame, see `retract`
  double overlap = 0.0;                     ///< see MatchResult
};

/// Looks for a scan at the place of one keyframe, made of that and the keyframes around it. With an
/// `expected` pose of the body in the map the scan is registered from there first; if that fails,
/// or without it, the scans are aligned with no guess. Nothing unless enough of the scan agrees
/// (`LoopParams::min_overlap`) at one clear pose.
std::optional<PlaceMatch> matchPlace(const MapState& map, int keyframe, const ScanFeatures& scan,
                                     const std::optional<PosePrior>& expected,
                                     const MapperParams& params);

}  // namespace opp::mapping
