// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"
#include "opp/primitives/line_params.h"
#include "opp/primitives/primitives.h"

#include <vector>

namespace opp {

/// Stretches of the intersection lines of `scan.edges` that have labelled samples of both planes
/// beside them, in the order of the edges and along n_a × n_b. A stretch that ends within
/// `params.reach` of one of `scan.corners` of both planes ends in that corner exactly. Kind:
/// concave if the planes stand in front of each other (on the viewpoint's side), convex if behind
/// each other, otherwise unknown. No edges or samples: empty. O(samples · log) per edge of a plane.
/// \throws std::invalid_argument if params are out of range or `scan.labels` has not one entry per
/// sample.
std::vector<LineSegment> findLines(const OrientedCloud& cloud, const Primitives& scan,
                                   const LineParams& params);

}  // namespace opp
