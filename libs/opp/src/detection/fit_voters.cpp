// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detection/fit_voters.h"

#include "detection/local_plane_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace opp {

Eigen::Vector3d meanNormal(const VotingScene& scene, const Voters& voters,
                           const Eigen::Vector3d& start) {
  Eigen::Vector3d sum = start;
  for (const std::uint32_t j : voters) {
    const Eigen::Vector3d normal = scene.samples[j].normal.cast<double>();
    sum += normal.dot(start) < 0.0 ? Eigen::Vector3d(-normal) : normal;
  }
  return sum.normalized();
}

Eigen::Vector3d densestHeight(const VotingScene& scene, const Voters& voters,
                              const Eigen::Vector3d& normal) {
  std::vector<std::pair<float, std::uint32_t>> heights;
  const Eigen::Vector3f direction = normal.cast<float>();
  for (const std::uint32_t j : voters) {
    heights.emplace_back(direction.dot(scene.samples[j].point), j);
  }
  std::sort(heights.begin(), heights.end());
  std::size_t first = 0, best_size = 0, best = 0;
  for (std::size_t last = 0; last < heights.size(); ++last) {
    const float width = 2.0F * scene.samples[heights[last].second].gate;
    while (heights[last].first - heights[first].first > width) ++first;
    if (last - first + 1 <= best_size) continue;
    best_size = last - first + 1;
    best = first + best_size / 2;
  }
  return scene.samples[heights[best].second].point.cast<double>();
}

std::optional<PlaneHypothesis> fitVoters(const VotingScene& scene, const Voters& voters,
                                         const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& normal, int min_votes) {
  Plane plane = Plane::fromPointNormal(origin, normal);
  Eigen::Vector3d anchor = origin;
  int votes = 0;
  // The first plane's normal is only as good as the normals, so its gate is wider.
  for (const double widening : {2.0, 1.0}) {
    LocalPlaneFit fit(plane.normal(), anchor);
    double slope_information = 0.0;
    for (const std::uint32_t j : voters) {
      const Eigen::Vector3d x = scene.samples[j].point.cast<double>();
      const auto gate = static_cast<double>(scene.samples[j].gate);
      if (std::abs(plane.signedDistance(x)) > widening * gate) continue;
      fit.add(x, 1.0 / (gate * gate));
      slope_information = 1.0;  // one vote's normal: slope of 1 rad per gate² weight
    }
    votes = fit.count();
    if (votes < min_votes) return std::nullopt;
    plane = fit.plane(slope_information);
    anchor = plane.project(fit.mean());
  }
  if (plane.signedDistance(scene.viewpoint) < 0.0) plane = plane.flipped();
  return PlaneHypothesis{plane, anchor, static_cast<double>(votes)};
}

}  // namespace opp
