// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/simulation/world.h"

#include <Eigen/Core>

namespace opp::test {

/// Distance [in lengths of the direction] to the first face of the world that a ray meets, found by
/// asking every face in double precision; infinity if there is none. \p nearest_edge becomes the
/// least distance [m] of the ray's hits, on any face's plane not behind the first hit, from that
/// face's outline: below float32 rounding nobody can say whether it hits.
double firstHit(const mapping::World& world, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction, double& nearest_edge);

}  // namespace opp::test
