// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"

#include <vector>

namespace opp::mapping {

/// Takes a map asunder where its ties leave open more than a variance [m²] of what is seen (see
/// `viewVariance`): what is left of it once those are cut, in the order of first keyframes. Several
/// loose ties hold if together they leave no direction open. All stay in the map's frame;
/// keyframes, landmarks and scans keep their order. A landmark that several see is in each of them,
/// with the observations made there; factors between them are gone. The one with most scans keeps
/// the count of loop closures. O(size of the map · parts + loose ties³).
std::vector<MapState> splitMap(MapState&& map, double max_variance);

}  // namespace opp::mapping
