// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"
#include "opp/primitives/corner_params.h"
#include "opp/primitives/primitives.h"

#include <array>
#include <vector>

namespace opp {

/// Triples of planes that are joined pairwise by edges, each ascending, in ascending order.
std::vector<std::array<int, 3>> findTriangles(const std::vector<OrthogonalityEdge>& edges);

/// Corners at the triangles of the plane graph: the exact intersection of the refined planes, if
/// every one of the three occupies a quarter of the disk around it (Sommer et al. 2020, III-c; a
/// fit of Eq. 5–7 to the few points nearby would be less exact than the planes are). Axes of the
/// LRF are the planes' normals, in ascending order of planes or with the last two swapped to be
/// right-handed. Covariance from the joint covariance of the planes. No triangle: empty.
/// \throws std::invalid_argument if params are out of range, or `scan.labels` or
/// `scan.normal_covariance` do not fit to cloud and families.
std::vector<Corner> findCorners(const OrientedCloud& cloud, const Primitives& scan,
                                const CornerParams& params);

}  // namespace opp
