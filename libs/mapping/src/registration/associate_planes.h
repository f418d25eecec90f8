// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/registration/local_map.h"
#include "opp/mapping/registration/registration_params.h"

#include "registration/match_input.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// Gives scan planes their landmarks (`ScanPlane::landmark`): of those on whose surfels enough of a
/// plane's points lie (`plane_vote_share`), the one with most, if the plane's samples fit it
/// (`plane_gate_sigmas`). Other planes stay as they are. O(points + planes).
void associatePlanes(const std::vector<ScanPoint>& points, const Eigen::Isometry3d& map_from_body,
                     const LocalMap& map, const RegistrationParams& params,
                     std::vector<ScanPlane>& planes);

}  // namespace opp::mapping
