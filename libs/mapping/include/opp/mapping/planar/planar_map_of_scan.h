// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"
#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/planar/planar_params.h"
#include "opp/primitives/primitives.h"

#include <optional>

namespace opp::mapping {

/// The planar map of one scan, in the frame of its cloud ("sensor"). Ids are the indices of the
/// primitives. Polygons come from the samples that `primitives.labels` assigns. Kinds of planes are
/// set if `up` (unit vector in the cloud's frame) is known; in one scan that is "horizontal" and
/// "vertical" only, because a floor cannot be told from a table; else "other". `timestamp` is the
/// single observation of planes and corners.
/// \throws std::invalid_argument if labels and cloud differ in length or a parameter is out of
/// range.
PlanarMap planarMapOfScan(const OrientedCloud& cloud, const Primitives& primitives,
                          const PlanarParams& params, double timestamp = 0.0,
                          const std::optional<Eigen::Vector3d>& up = std::nullopt);

}  // namespace opp::mapping
