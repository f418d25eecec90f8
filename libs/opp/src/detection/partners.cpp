// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detection/partners.h"

namespace opp {

Partners::Partners(Eigen::Index capacity)
    : x(capacity),
      y(capacity),
      z(capacity),
      nx(capacity),
      ny(capacity),
      nz(capacity),
      gate(capacity) {}

void drawPartners(const VotingScene& scene, std::uint32_t r,
                  std::vector<NeighbourhoodGrid::Range>& cells, Partners& partners) {
  const Eigen::Vector3f reference = scene.samples[r].point;
  cells.clear();
  scene.grid.cellsNear(reference, scene.radius, cells);
  std::uint64_t candidates = 0;
  for (const auto& cell : cells) candidates += cell.size();
  const auto wanted = static_cast<std::uint64_t>(scene.params.partners);
  // Each cell gives its share, rounded so that the shares add up to min(K, candidates). A stretch
  // that starts at another place for each reference point makes their draws differ.
  std::uint64_t seen = 0, drawn = 0;
  partners.size = 0;
  for (const auto& cell : cells) {
    seen += cell.size();
    const std::uint64_t due = candidates <= wanted ? seen : seen * wanted / candidates;
    std::uint32_t j = cell.begin + r % cell.size();
    for (; drawn < due; ++drawn) {
      const VotingSample& sample = scene.samples[j];
      const Eigen::Index k = partners.size++;
      partners.x[k] = sample.point.x() - reference.x();
      partners.y[k] = sample.point.y() - reference.y();
      partners.z[k] = sample.point.z() - reference.z();
      partners.nx[k] = sample.normal.x();
      partners.ny[k] = sample.normal.y();
      partners.nz[k] = sample.normal.z();
      partners.gate[k] = sample.gate;
      if (++j == cell.end) j = cell.begin;
    }
  }
}

}  // namespace opp
