// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/core/trajectory.h"

#include <filesystem>
#include <string>

namespace opp::mapping {

/// The map seen from above as SVG: floor, walls, way of the body, a scale bar. Plumb planes are
/// thick where they are cut 1.2 m above the floor, as in an architect's plan, so that doors and
/// windows show as gaps, and thin where they are lower or higher only. `up`: unit vector in the
/// map's frame. 100 units a metre; the plan is turned so that walls run along the page. An empty
/// map is a page with a scale bar.
std::string floorplanSvg(const PlanarMap& map, const Trajectory& trajectory,
                         const Eigen::Vector3d& up);

/// Writes floorplanSvg to a file, whole or not at all.
/// \throws std::runtime_error if the file cannot be written.
void writeFloorplan(const std::filesystem::path& path, const PlanarMap& map,
                    const Trajectory& trajectory, const Eigen::Vector3d& up);

}  // namespace opp::mapping
