// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/map_state.h"

namespace opp::mapping {

/// The sensor model with the distortion that the map shows, if that is less: how much worse than by
/// their noise planes agree with landmarks that several keyframes saw, over what the model's
/// distortion would make of it (median of the mean squares). The model's where no landmark tells.
/// O(factors log factors).
SensorModel withShownDistortion(const SensorModel& sensor, const MapState& map);

}  // namespace opp::mapping
