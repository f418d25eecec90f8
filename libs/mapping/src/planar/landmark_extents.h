// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/planar/planar_params.h"
#include "opp/mapping/planar/plane_extent.h"

#include <vector>

namespace opp::mapping {

/// Times of the scans that saw a landmark: each once, ascending [s].
std::vector<double> timesOf(const PlaneLandmark& landmark, const MapState& map);

/// Where each plane landmark was seen, by id, of a map whose views were adopted (`adoptViews`).
/// O(samples of all keyframes).
std::vector<PlaneExtent> landmarkSupports(const MapState& map, double cell);

/// Where each plane landmark was seen and looked through, by id. Rays are those of
/// keyframes. Of a map whose views were adopted (`adoptViews`). O(samples of all keyframes ×
/// landmarks).
std::vector<PlaneExtent> landmarkExtents(const MapState& map, const PlanarParams& params);

/// Of the scans that looked where a landmark was seen, the share that saw it, 0–1; by landmark, 0
/// for those without observations. A keyframe looked there if it, or a scan that follows it, saw
/// the landmark, or if `PlanarParams::min_rays` of its rays meet the landmark's support or pass
/// through it; so did the scans that follow. What is there is seen by many; what noise made up, or
/// things that happen to be in line, is not. O(samples of all keyframes × landmarks).
std::vector<double> seenShares(const MapState& map, const std::vector<PlaneExtent>& extents,
                               const PlanarParams& params);

}  // namespace opp::mapping
