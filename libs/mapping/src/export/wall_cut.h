// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace opp::mapping {

/// A stretch of a wall, seen from above.
using WallStretch = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

/// Where a level cut at height z goes through the polygons of a plumb plane, in a frame whose z
/// axis is up.
std::vector<WallStretch> cutAt(double z, const PlanarMapPlane& plane);

/// The polygons of a plumb plane seen from above: one stretch each.
std::vector<WallStretch> footprintsOf(const PlanarMapPlane& plane);

}  // namespace opp::mapping
