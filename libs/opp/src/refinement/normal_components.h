// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/refinement/solve_normals.h"

#include <cstddef>
#include <vector>

namespace opp {

/// A part of a problem that nothing couples to the rest.
struct NormalComponent {
  std::vector<std::size_t> normals;  ///< of the whole problem, ascending
  NormalProblem problem;             ///< with places in `normals` for indices
};

/// The parts of a valid problem, by their first normals. O(normals + edges).
std::vector<NormalComponent> normalComponents(const NormalProblem& problem);

}  // namespace opp
