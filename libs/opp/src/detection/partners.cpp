// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detection/partners.h"

#include <algorithm>

namespace opp {

Partners::Partners(Eigen::Index capacity)
    : x(capacity),
      y(capacity),
      z(capacity),
      nx(capacity),
      ny(capacity),
      nz(capacity),
      gate(capacity) {}

namespace {

/// Appends `count` samples that lie side by side.
void append(const VotingSample* samples, std::uint64_t count, const Eigen::Vector3f& reference,
            Partners& partners) {
  const Eigen::Index at = partners.size;
  float *x = partners.x.data() + at, *y = partners.y.data() + at, *z = partners.z.data() + at;
  float *nx = partners.nx.data() + at, *ny = partners.ny.data() + at, *nz = partners.nz.data() + at;
  float* gate = partners.gate.data() + at;
  const float x0 = reference.x(), y0 = reference.y(), z0 = reference.z();
  for (std::uint64_t k = 0; k < count; ++k) {
    const VotingSample& sample = samples[k];
    x[k] = sample.point.x() - x0, y[k] = sample.point.y() - y0, z[k] = sample.point.z() - z0;
    nx[k] = sample.normal.x(), ny[k] = sample.normal.y(), nz[k] = sample.normal.z();
    gate[k] = sample.gate;
  }
  partners.size += static_cast<Eigen::Index>(count);
}

}  // namespace

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
    while (drawn < due) {
      const auto count = std::min(due - drawn, static_cast<std::uint64_t>(cell.end - j));
      append(scene.samples.data() + j, count, reference, partners);
      drawn += count;
      j = cell.begin;
    }
  }
}

}  // namespace opp
