// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"

namespace opp::mapping {

/// Optimizes the keyframes `first_free` ≥ 1 … and their landmarks (`optimizeMap`), joins landmarks
/// that turn out to be one surface (`mergeLandmarks`), and optimizes once more where any were.
/// Corner landmarks follow their planes. Nothing to do for a map of fewer than two keyframes.
void settleMap(MapState& map, int first_free, const MapperParams& params);

}  // namespace opp::mapping
