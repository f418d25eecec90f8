// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/map_state.h"

namespace opp::mapping {

/// Makes what only scans between keyframes saw primitives of the keyframes they follow: planes, of
/// the landmark they scatter least apart from if noise explains that and no keyframe saw both, else
/// of a new one, which is fitted to all its views; and their lines and corners. For the map whose
/// poses are final: to an optimization, views would be measurements that share the errors of the
/// scans' poses. To be called once. Returns how many landmarks there are more. O(planes of views ×
/// landmarks).
int adoptViews(const SensorModel& sensor, MapState& map);

}  // namespace opp::mapping
