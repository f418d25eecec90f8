// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/core/trajectory.h"
#include "opp/mapping/planar/planar_params.h"

#include <filesystem>

namespace opp::mapping {

/// Writes what a finished run holds beside planar_map.json: planar_map.ply, .obj and .glb,
/// floorplan.svg, scene.3Dscene. Up is estimated from the planes (estimateUp), else it is the map's
/// z axis. \throws std::runtime_error if a file cannot be written.
void writePlanarExports(const std::filesystem::path& folder, const PlanarMap& map,
                        const Trajectory& trajectory, const PlanarParams& params);

}  // namespace opp::mapping
