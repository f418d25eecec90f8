// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"

#include <Eigen/Geometry>

namespace opp::mapping {

/// The same map expressed in frame b: planes, polygons, lines, corners and families. Covariances of
/// planes and corners are left as they are: evaluation does not use them, and they would need the
/// uncertainty of b_from_a.
PlanarMap movedPlanarMap(const Eigen::Isometry3d& b_from_a, PlanarMap map_in_a);

}  // namespace opp::mapping
