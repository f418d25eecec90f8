// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"

#include <vector>

namespace opp::mapping {

/// Takes a map asunder into sets of keyframes, see `tiedSets`: what is left of it once the ties
/// between them are cut, in the order of sets. All stay in the map's frame; keyframes, landmarks
/// and scans keep their order. A landmark that several see is in each of them, with the
/// observations made there; factors between them are gone. The one with most scans keeps the count
/// of loop closures. O(size of the map · sets).
std::vector<MapState> splitMap(MapState&& map, const std::vector<int>& sets);

}  // namespace opp::mapping
