// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/oriented_cloud.h"
#include "opp/geometry/point_cloud.h"
#include "opp/params/primitive_params.h"
#include "opp/primitives/primitives.h"
#include "opp/primitives/stage_timings.h"

namespace opp {

/// Planes, their orthogonality, lines and corners in one scan (Sommer et al. 2020, III and IV):
/// votes for orthogonal plane pairs, their graph, its joint refinement, corners at the graph's
/// triangles and lines along its edges. Everything is in the cloud's frame. Empty for clouds of
/// fewer than three samples. Same result for every `threads` (≤ 0: all cores). Fills its
/// stages in `timings` unless null. \throws std::invalid_argument if a parameter is out of range.
Primitives detectPrimitives(const OrientedCloud& cloud, const PrimitiveParams& params,
                            int threads = 1, StageTimings* timings = nullptr);

/// As above, with more detail: samples on no large plane are split into the patches that they were
/// averaged from, and in depth images planes too narrow for patches are found pixel by pixel, in
/// `cloud`, which `makeScanSurface` made the surface of. The labels are of `surface.samples` as
/// they are then.
Primitives detectPrimitives(const PointCloud& cloud, ScanSurface& surface,
                            const PrimitiveParams& params, int threads = 1,
                            StageTimings* timings = nullptr);

}  // namespace opp
