// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/map_state.h"

namespace opp::mapping {

/// Joins plane landmarks that have turned out to be one surface: they face the same way, their
/// supports touch, and one plane explains the samples of both to within `gate_sigmas` (root mean
/// square): so well that no pair loses its influence on the map (`BackendParams::kernel_width`). A
/// laxer gate takes a board for the wall behind it, and keyframes before bare walls slide along
/// them to make up for it. Of two, the older stays; the other
/// keeps its id but has no observations any more. Returns how many were joined. O(planes²) plus one
/// fit per near pair.
int mergeLandmarks(MapState& map, double gate_sigmas);

/// Joins those, too, that only the sensor's distortion sets apart: a bent wall looks like another
/// plane from each viewpoint. Their samples lie about a common plane, and they are tilted to it,
/// within `gate_sigmas` of noise and distortion, and no keyframe saw both: one scan tells a layer
/// from the wall behind it by the step between them. For the finished map: as measurements of one
/// plane the pieces contradict each other and would bend the trajectory. Else as above.
int mergeDistortedLandmarks(MapState& map, const SensorModel& sensor, double gate_sigmas);

}  // namespace opp::mapping
