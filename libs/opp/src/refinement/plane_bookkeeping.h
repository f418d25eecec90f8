// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"
#include "opp/primitives/primitives.h"
#include "opp/refinement/refinement_params.h"

#include "refinement/same_surface.h"
#include "refinement/sample_assignment.h"

#include <vector>

namespace opp {

/// λ stays finite when systematic_angle is 0: (1e-6 rad)² is orthogonal for every purpose.
inline constexpr double kLeastAngleVariance = 1e-12;

/// Least-squares normal of a point set; directions that the points do not fix stay as in `known`.
Eigen::Vector3d ownNormal(const Eigen::Matrix3d& scatter, const Eigen::Vector3d& known);

/// New index of each plane after dropping curved ones and those with too few samples (−1) and
/// merging those that are one surface; a merged plane's sums go to the one with more support.
std::vector<int> survivors(SameSurface& same_surface, const RefinementParams& params,
                           std::vector<PlaneFit>& fits);

/// Renumbers planes and edges by `new_index`; edges that lose a plane go, equal ones add votes.
void compact(const std::vector<int>& new_index, std::vector<PlaneFit>& fits,
             std::vector<OrthogonalityEdge>& edges);

/// The refined plane, with its normal on the viewpoint's side; `scan` holds families and their
/// normals' covariance already.
PlanePrimitive primitiveOf(const PlaneFit& fit, int family, const OrientedCloud& cloud,
                           const Primitives& scan);

}  // namespace opp
