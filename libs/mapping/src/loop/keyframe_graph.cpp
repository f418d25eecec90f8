// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/keyframe_graph.h"

#include "registration/observability.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace opp::mapping {

double leverOf(const Keyframe& keyframe) {
  return std::max(keyframe.view_centre_in_body.norm(), 1.0);
}

double viewVariance(const Matrix6d& covariance, const Keyframe& keyframe) {
  const double lever = leverOf(keyframe);
  return largestVariance(covariance.bottomRightCorner<3, 3>()) +
         lever * lever * largestVariance(covariance.topLeftCorner<3, 3>());
}

std::vector<double> relativeVariances(const MapState& map, int from) {
  using Index = std::size_t;
  std::vector<std::vector<std::pair<int, double>>> neighbours(map.keyframes.size());
  for (const KeyframeLink& link : map.links) {
    neighbours[Index(link.first)].emplace_back(link.second, link.variance);
    neighbours[Index(link.second)].emplace_back(link.first, link.variance);
  }
  std::vector<double> variances(map.keyframes.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  variances[Index(from)] = 0.0;
  open.emplace(0.0, from);
  while (!open.empty()) {
    const auto [variance, keyframe] = open.top();
    open.pop();
    if (variance > variances[Index(keyframe)]) continue;
    for (const auto& [next, step] : neighbours[Index(keyframe)]) {
      if (variance + step >= variances[Index(next)]) continue;
      variances[Index(next)] = variance + step;
      open.emplace(variance + step, next);
    }
  }
  return variances;
}

std::vector<int> nearestViews(const MapState& map, int near, const std::vector<double>& variances,
                              double max_variance, int count) {
  const Eigen::Vector3d here = map.keyframes[static_cast<std::size_t>(near)].viewCentre();
  std::vector<std::pair<double, int>> by_distance;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (variances[k] > max_variance) continue;
    by_distance.emplace_back((map.keyframes[k].viewCentre() - here).squaredNorm(),
                             static_cast<int>(k));
  }
  const auto kept = std::min(by_distance.size(), static_cast<std::size_t>(std::max(count, 0)));
  const auto last = by_distance.begin() + static_cast<std::ptrdiff_t>(kept);
  std::partial_sort(by_distance.begin(), last, by_distance.end());
  std::vector<int> ids;
  for (auto entry = by_distance.begin(); entry != last; ++entry) ids.push_back(entry->second);
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace opp::mapping
