// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"

#include <Eigen/Geometry>

namespace opp::mapping {

/// The same map expressed in frame b, with all geometry and covariances; b_from_a is taken as exact.
/// `frame` keeps its name.
PlanarMap movedPlanarMap(const Eigen::Isometry3d& b_from_a, PlanarMap map_in_a);

}  // namespace opp::mapping
