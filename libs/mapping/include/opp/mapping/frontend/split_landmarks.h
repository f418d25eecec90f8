// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/backend/backend_params.h"
#include "opp/mapping/core/map_state.h"

namespace opp::mapping {

/// Takes plane landmarks apart whose observations contradict each other: two table tops that were
/// taken for one when less was known. Those that one plane explains to within
/// `BackendParams::kernel_width` times their noise and the distortion that the map shows stay
/// together, those of most weight first; each further set becomes a landmark at the end of the
/// list. Returns how many were added. O(observations × sets of a landmark).
int splitLandmarks(MapState& map, const SensorModel& sensor, const BackendParams& params);

}  // namespace opp::mapping
