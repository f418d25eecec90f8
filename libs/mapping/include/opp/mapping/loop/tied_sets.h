// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"

#include <vector>

namespace opp::mapping {

/// Sets of keyframes whose ties leave open at most a variance [m²] of what is seen (see
/// `viewVariance`): for each keyframe the number of its set, in the order of first keyframes.
/// Several loose ties hold if together they leave no direction open. O(keyframes · links + loose
/// ties³).
std::vector<int> tiedSets(const MapState& map, double max_variance);

}  // namespace opp::mapping
