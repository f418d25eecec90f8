// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/primitives/primitives.h"
#include "opp/refinement/refinement_params.h"

#include "refinement/sample_assignment.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace opp {

/// Marks the fits whose samples' normals turn with the place by more than `max_turn` across their
/// extent, and by more than the normals' scatter could feign: strips of cylinders and spheres.
void markCurved(const std::vector<WeightedSample>& samples, const std::vector<int>& labels,
                const RefinementParams& params, std::vector<PlaneFit>& fits);

/// Two parallel surfaces that a plane was fitted between (a cupboard's back on a wall), the larger
/// first; nothing if its samples, the `members`, do not fall in two clearly separate layers of at
/// least `min_support` samples each.
std::optional<std::array<PlaneFit, 2>> splitLayers(const std::vector<WeightedSample>& samples,
                                                   const std::vector<std::uint32_t>& members,
                                                   const PlaneFit& fit,
                                                   const RefinementParams& params);

/// Replaces planes that `splitLayers` divides by their halves: the larger takes the plane's place,
/// the other is appended; both inherit the edges. True if there was one.
bool splitPlanes(const std::vector<WeightedSample>& samples, const std::vector<int>& labels,
                 const RefinementParams& params, std::vector<PlaneFit>& fits,
                 std::vector<OrthogonalityEdge>& edges);

}  // namespace opp
