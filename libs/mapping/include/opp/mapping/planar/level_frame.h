// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"

#include <Eigen/Geometry>

namespace opp::mapping {

/// Rotation to a frame for looking at a map: z along `up` (unit vector in the map's frame), x and y
/// along the walls, or along the map's own axes where there are none. Of the four such frames the
/// one nearest to the map's.
Eigen::Isometry3d levelFromMap(const PlanarMap& map, const Eigen::Vector3d& up);

}  // namespace opp::mapping
