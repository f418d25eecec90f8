// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/backend/backend_params.h"
#include "opp/mapping/core/map_state.h"

#include <vector>

namespace opp::mapping {

/// Joins each landmark with that of id `joined_with[its id]`, which may be its own; the id stays,
/// without observations.
void joinLandmarks(const std::vector<int>& joined_with, MapState& map);

/// Joins plane landmarks that have turned out to be one surface: they face the same way, their
/// supports touch, no keyframe told them apart, and one plane explains the samples of both to
/// within `gate_sigmas` (root mean square): so well that no pair loses its influence on the map
/// (`BackendParams::kernel_width`). A laxer gate takes a board for the wall behind it, and
/// keyframes before bare walls slide along them to make up for it. Of two, the older stays; the
/// other keeps its id but has no observations any more. Returns how many were joined. O(planes²)
/// plus one fit per near pair.
int mergeLandmarks(MapState& map, double gate_sigmas);

/// For the finished map, joins those, too, that stand for one plane of the scene:
/// - parts of one plane, wherever they lie, that are known so well that their agreement proves it
///   (`BackendParams::coplanar_resolution`): a wall beyond a doorway;
/// - what only the sensor's distortion sets apart: a bent wall looks like another plane from each
///   viewpoint. Their samples lie about a common plane, and they are tilted to it, within
///   `BackendParams::kernel_width` times the distortion that the map shows (at most the model's),
///   they touch, and no keyframe saw both: one scan tells a layer from the wall behind it by the
///   step between them.
/// Not while the map grows: as measurements of one plane, bent pieces would bend the trajectory.
/// Returns how many were joined. O(planes²).
int unifyPlanes(MapState& map, const SensorModel& sensor, const BackendParams& params);

}  // namespace opp::mapping
