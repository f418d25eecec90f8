// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"

namespace opp::mapping {

/// Looks for loops between the sets of keyframes that a map ties too loosely (`tiedSets`): before
/// it is taken asunder, now that all has been seen. As it grew, only its newest keyframe looked
/// back; here each (some tens of a set, spread evenly) looks for the places of the other sets, and
/// what joined the map later is known, too. A loop is believed as that of a LoopCloser is, and if
/// the two sets do not stand in each other's free space under it. Returns how many were closed.
/// \param max_variance see `tiedSets` [m²]
int closeLooseTies(double max_variance, const MapperParams& params, MapState& map);

}  // namespace opp::mapping
