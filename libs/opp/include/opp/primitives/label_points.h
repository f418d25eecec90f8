// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"
#include "opp/params/primitive_params.h"
#include "opp/primitives/primitives.h"

#include <vector>

namespace opp {

/// Plane (index into `primitives.planes`) of each point of the raw cloud, −1: none. `samples` and
/// `primitives` are what makeOrientedCloud and detectPrimitives made of it. A point belongs to a
/// plane that has a sample near it and that explains its offset by the sensor's noise (`noise_gate`
/// and `flatness` of the graph, as for samples); of several the one that explains it best. Points
/// that are not finite have none. O(points).
/// \throws std::invalid_argument if there is not one label per sample.
std::vector<int> labelPoints(const PointCloud& cloud, const OrientedCloud& samples,
                             const Primitives& primitives, const PrimitiveParams& params);

}  // namespace opp
