// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"
#include "opp/graph/plane_graph.h"
#include "opp/params/primitive_params.h"

#include "cloud/grid_patches.h"

namespace opp {

/// Looks in a depth image for planes that are too narrow for patches: strips some pixels wide, and
/// those of the graph that patches astride of their edges may turn by more than a little. They take
/// the place of such nodes, and samples of their own pixels that of the samples there. Does nothing
/// if the image, which the samples were made of by way of `grid`, is a full turn. The nodes that
/// stay keep their order; those found follow.
void addNarrowPlanes(const PointCloud& image, const GridPatches& grid,
                     const PrimitiveParams& params, OrientedCloud& samples, PlaneGraph& graph);

}  // namespace opp
