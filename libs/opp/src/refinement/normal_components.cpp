// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/normal_components.h"

#include "opp/graph/union_find.h"

#include <utility>

namespace opp {

std::vector<NormalComponent> normalComponents(const NormalProblem& problem) {
  UnionFind sets(problem.scatters.size());
  const auto join = [&](int a, int b) {
    sets.join(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
  };
  for (const auto& frame : problem.frames) {
    for (const int normal : frame) join(frame.front(), normal);
  }
  for (const auto& edge : problem.soft_edges) join(edge.normals[0], edge.normals[1]);
  std::vector<NormalComponent> components;
  std::vector<std::size_t> component_of_root(problem.scatters.size(), problem.scatters.size());
  std::vector<int> place(problem.scatters.size());
  const auto componentOf = [&](std::size_t k) -> NormalComponent& {
    return components[component_of_root[sets.root(k)]];
  };
  for (std::size_t k = 0; k < problem.scatters.size(); ++k) {
    std::size_t& component = component_of_root[sets.root(k)];
    if (component == problem.scatters.size()) {
      component = components.size();
      components.emplace_back();
    }
    place[k] = static_cast<int>(components[component].normals.size());
    components[component].normals.push_back(k);
    components[component].problem.scatters.push_back(problem.scatters[k]);
  }
  const auto placeOf = [&](int normal) { return place[static_cast<std::size_t>(normal)]; };
  for (NormalProblem::Frame frame : problem.frames) {
    NormalComponent& component = componentOf(static_cast<std::size_t>(frame.front()));
    for (int& normal : frame) normal = placeOf(normal);
    component.problem.frames.push_back(std::move(frame));
  }
  for (const auto& edge : problem.soft_edges) {
    componentOf(static_cast<std::size_t>(edge.normals[0]))
        .problem.soft_edges.push_back(
            {{placeOf(edge.normals[0]), placeOf(edge.normals[1])}, edge.information});
  }
  return components;
}

}  // namespace opp
