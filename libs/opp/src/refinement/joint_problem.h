// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/refinement/find_structure.h"
#include "opp/refinement/refinement_params.h"
#include "opp/refinement/solve_normals.h"

#include "refinement/sample_assignment.h"

#include <Eigen/Core>

#include <vector>

namespace opp {

/// What each plane's samples alone say about its normal, less what `PlaneFit::information` doubts.
std::vector<NormalEstimate> normalEstimates(const std::vector<PlaneFit>& fits);

/// The families' present normals.
std::vector<Eigen::Vector3d> familyNormals(const PlaneStructure& structure,
                                           const std::vector<PlaneFit>& fits);

/// What the samples of all planes say about the families' normals; with `rims`, less what
/// `PlaneFit::information` doubts.
NormalProblem normalProblem(const PlaneStructure& structure, const std::vector<PlaneFit>& fits,
                            const RefinementParams& params, bool rims = false);

/// Marks planes of whose direction neither their samples nor parallel or orthogonal planes tell
/// enough. \param normals of the families.
void markUncertain(const PlaneStructure& structure, const std::vector<Eigen::Vector3d>& normals,
                   const RefinementParams& params, std::vector<PlaneFit>& fits);

}  // namespace opp
