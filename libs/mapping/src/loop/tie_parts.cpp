// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/tie_parts.h"

#include "opp/mapping/loop/join_maps.h"
#include "opp/mapping/loop/keyframe_graph.h"

#include "registration/observability.h"

#include <algorithm>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// −1: not in the map.
int keyframeOf(const MapState& map, const ScanId& id) {
  const auto found = std::find_if(map.keyframes.begin(), map.keyframes.end(),
                                  [&](const Keyframe& k) { return k.features.id() == id; });
  return found == map.keyframes.end() ? -1 : static_cast<int>(found - map.keyframes.begin());
}

/// What ties a keyframe of one map to one of another.
struct Tie {
  RelativePoseFactor factor;  ///< ids of each in its own map
  bool first_in_a = true;     ///< else `factor.first` is of b
  double variance = 0.0;      ///< see KeyframeLink
};

std::vector<Tie> tiesBetween(const MapPart& a, const MapPart& b) {
  std::vector<Tie> ties;
  PartHistory both = a.history;
  both.merge(b.history);
  for (const ExpectedBeginning& beginning : both.beginnings) {
    for (const bool first_in_a : {true, false}) {
      const MapState& of_first = first_in_a ? a.map : b.map;
      const MapState& of_second = first_in_a ? b.map : a.map;
      const int first = keyframeOf(of_first, beginning.last);
      const int second = keyframeOf(of_second, beginning.first);
      if (first < 0 || second < 0) continue;
      ties.push_back(
          {{first, second, beginning.last_from_first, beginning.information},
           first_in_a,
           viewVariance(covarianceOf(beginning.information), of_second.keyframes[Index(second)])});
    }
  }
  return ties;
}

Eigen::Isometry3d aFromB(const Tie& tie, const MapState& a, const MapState& b) {
  const MapState& of_first = tie.first_in_a ? a : b;
  const MapState& of_second = tie.first_in_a ? b : a;
  const Eigen::Isometry3d first_from_second_map =
      of_first.keyframes[Index(tie.factor.first)].map_from_body * tie.factor.first_from_second *
      of_second.keyframes[Index(tie.factor.second)].map_from_body.inverse();
  return tie.first_in_a ? first_from_second_map : first_from_second_map.inverse();
}

bool tieTwo(MapPart& a, MapPart& b) {
  if (!a.history.sharesOrigin(b.history)) return false;
  std::vector<Tie> ties = tiesBetween(a, b);
  if (ties.empty()) return false;
  const auto firmest = std::min_element(
      ties.begin(), ties.end(), [](const Tie& x, const Tie& y) { return x.variance < y.variance; });
  const int offset = static_cast<int>(a.map.keyframes.size());
  appendMap(aFromB(*firmest, a.map, b.map), std::move(b.map), a.map);
  for (Tie& tie : ties) {
    (tie.first_in_a ? tie.factor.second : tie.factor.first) += offset;
    a.map.factors.relative_poses.push_back(tie.factor);
    a.map.links.push_back({tie.factor.first, tie.factor.second, tie.variance});
  }
  a.indexFrom(Index(offset));
  a.history.merge(b.history);
  return true;
}

}  // namespace

bool tieParts(std::vector<MapPart>& parts) {
  bool any = false;
  for (Index a = 0; a < parts.size(); ++a) {
    for (Index b = a + 1; b < parts.size();) {
      if (!tieTwo(parts[a], parts[b])) {
        ++b;
        continue;
      }
      any = true;
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(b));
      b = a + 1;  // what was not tied to the one may be to the other
    }
  }
  return any;
}

}  // namespace opp::mapping
