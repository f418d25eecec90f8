// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/graph/plane_graph.h"

#include "support/random.h"
#include "support/synthetic_room.h"

namespace opp::test {

/// What voting might give for a scene: its true planes, each turned by up to `angle` [rad] about
/// the mean of its samples and moved by up to `offset` [m], with the scene's edges (one vote each).
PlaneGraph roughGraph(const SyntheticScene& scene, double angle, double offset, Random& random);

}  // namespace opp::test
