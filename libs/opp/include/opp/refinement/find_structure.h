// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_moments.h"
#include "opp/primitives/primitives.h"
#include "opp/refinement/refinement_params.h"
#include "opp/refinement/solve_normals.h"

#include <array>
#include <vector>

namespace opp {

/// What a single plane's own points say about its normal.
struct NormalEstimate {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< Σ w (x−mean)(x−mean)ᵀ, weights 1/σ²
};

/// Parallelism and orthogonality that the data support.
struct PlaneStructure {
  std::vector<std::vector<int>> families;      ///< plane ids, ascending; every plane is in one
  std::vector<int> family_of;                  ///< per plane
  std::vector<NormalProblem::Frame> frames;    ///< families kept orthogonal exactly
  std::vector<std::array<int, 2>> soft_edges;  ///< further orthogonal pairs of families
  std::vector<OrthogonalityEdge> edges;        ///< those of the input that passed the test
};

/// Tests which planes are parallel and which families orthogonal, each against the covariance of
/// its normals plus `systematic_angle`: χ² with 2 and 1 degrees of freedom. Planes join the family
/// that fits best, most points first. Families linked by edges form components; inside a component
/// every pair is tested, and the orthogonal triples with most points, then pairs, become frames.
/// Structure that the data deny is left out. O(planes × families + families³), no randomness.
PlaneStructure findStructure(const std::vector<NormalEstimate>& planes,
                             const std::vector<OrthogonalityEdge>& edges,
                             const RefinementParams& params);

}  // namespace opp
