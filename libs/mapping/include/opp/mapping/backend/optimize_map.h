// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/mapping/backend/backend_params.h"
#include "opp/mapping/core/map_factors.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// Outcome of `optimizeMap`.
struct OptimizationReport {
  bool converged = true;
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
};

/// Jointly optimizes the poses of keyframes `first_free` … and all planes they see.
///
/// The residual of a (keyframe, plane) pair is Lᵀ(Tᵀπ), four numbers (PointMoments::factor): exact
/// point-to-plane bundle adjustment over all samples at a cost per pair. Keyframes before
/// `first_free` keep their poses; first_free must be ≥ 1 so that the map's frame stays fixed.
/// Planes that no free keyframe sees keep theirs. Single-threaded and deterministic. \throws
/// std::invalid_argument if a factor names a keyframe or landmark that does not exist.
OptimizationReport optimizeMap(const MapFactors& factors, int first_free,
                               const BackendParams& params,
                               std::vector<Eigen::Isometry3d>& map_from_keyframe,
                               std::vector<Plane>& planes_in_map);

}  // namespace opp::mapping
