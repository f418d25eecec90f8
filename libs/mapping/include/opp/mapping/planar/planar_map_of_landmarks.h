// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/planar/planar_params.h"

namespace opp::mapping {

/// The planar abstraction of a map: each plane landmark with polygons around all that was seen of
/// it, the lines that were seen of each pair of landmarks, and the corner landmarks. Left out, with
/// their lines and corners, are planes without a polygon (too little support), those whose place
/// noise and distortion leave too uncertain (`PlanarParams::max_position_error`), those that too
/// few of the scans that looked there saw (`min_seen_share`), and small ones that one scan saw
/// (`single_scan_area`); the others are numbered anew. Of views those count that were adopted
/// (`adoptViews`). Cost: O(samples of all keyframes × planes) for the rays that meet planes.
PlanarMap planarMapOf(const MapState& map, const SensorModel& sensor, const PlanarParams& params);

}  // namespace opp::mapping
