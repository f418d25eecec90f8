// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"

namespace opp::mapping {

/// Lets sets of keyframes that a map ties too loosely (`tiedSets`) agree on what is level: a floor,
/// a table or a ceiling is so within `loop.level_sigma`, and each set has seen some. A bare wall
/// between them leaves open how far the one is turned about the wall's normal, and by that most of
/// where it lies. A tie that denies it is left alone: what one of the two takes for level is not.
/// Only ties change, `settleMap` takes the keyframes there. True if there were any.
/// \param max_variance see `tiedSets` [m²]
/// O(sets³ + planes).
bool levelTies(double max_variance, const MapperParams& params, MapState& map);

}  // namespace opp::mapping
