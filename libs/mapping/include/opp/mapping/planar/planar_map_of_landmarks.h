// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/planar/planar_params.h"

namespace opp::mapping {

/// The planar abstraction of a map: each plane landmark with polygons around all that its keyframes
/// saw of it, the lines that the keyframes saw of each pair of landmarks, and the corner landmarks.
/// Planes without a polygon (too little support), and those whose place noise and distortion leave
/// too uncertain (`PlanarParams::max_position_error`), are left out, with their lines and corners;
/// the others are numbered anew. Cost: O(samples of all keyframes × planes) for the rays that pass
/// through planes.
PlanarMap planarMapOf(const MapState& map, const SensorModel& sensor, const PlanarParams& params);

}  // namespace opp::mapping
