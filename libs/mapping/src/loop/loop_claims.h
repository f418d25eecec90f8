// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/loop/claim_pool.h"

#include <functional>
#include <vector>

namespace opp::mapping {

/// Claims of a keyframe to see what others of its map saw: those that `eligible` approves of, that
/// are near by the map's own estimate, as far as drift allows, but not tied to it well enough to be
/// matched as one surface (LoopParams::max_candidates of them, at different places).
std::vector<PlaceClaim> loopClaims(const MapState& map, int keyframe,
                                   const std::function<bool(int)>& eligible,
                                   const MapperParams& params);

/// How far the present poses are from a claim [m]: of what keyframe b sees, and by the turn of its
/// view. A lidar in the middle of a symmetric hall sees the same centre when turned around.
double disagreement(const MapState& map, const PlaceClaim& claim);

}  // namespace opp::mapping
