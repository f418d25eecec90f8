// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/map_part.h"

#include <algorithm>

namespace opp::mapping {

bool PartHistory::sharesOrigin(const PartHistory& other) const {
  return std::any_of(origins.begin(), origins.end(),
                     [&](int id) { return other.origins.count(id) > 0; });
}

void PartHistory::merge(const PartHistory& other) {
  origins.insert(other.origins.begin(), other.origins.end());
  for (const ExpectedBeginning& beginning : other.beginnings) expect(beginning);
  repeated.insert(other.repeated.begin(), other.repeated.end());
}

void PartHistory::expect(const ExpectedBeginning& beginning) {
  const bool known =
      std::any_of(beginnings.begin(), beginnings.end(), [&](const ExpectedBeginning& other) {
        return other.last == beginning.last && other.first == beginning.first;
      });
  if (!known) beginnings.push_back(beginning);
}

void PartHistory::expectTied(const MapState& map, const std::vector<int>& sets) {
  for (const RelativePoseFactor& f : map.factors.relative_poses) {
    const auto first = static_cast<std::size_t>(f.first),
               second = static_cast<std::size_t>(f.second);
    if (sets[first] == sets[second]) continue;
    const ScanFeatures& from = map.keyframes[first].features;
    const ScanFeatures& to = map.keyframes[second].features;
    expect({from.id(), to.id(), f.first_from_second, f.information});
  }
}

void MapPart::indexFrom(std::size_t first_keyframe) {
  for (std::size_t k = first_keyframe; k < map.keyframes.size(); ++k)
    index.add(map.keyframes[k].features.primitives_in_body);
}

bool MapPart::seesRepeated(int keyframe, double reach) const {
  if (history.repeated.empty()) return false;
  const Eigen::Vector3d view = map.keyframes[static_cast<std::size_t>(keyframe)].viewCentre();
  return std::any_of(map.keyframes.begin(), map.keyframes.end(), [&](const Keyframe& other) {
    return history.repeated.count(other.features.id()) > 0 &&
           (other.viewCentre() - view).norm() <= reach;
  });
}

void MapPart::markRepeated(int keyframe) {
  history.repeated.insert(map.keyframes[static_cast<std::size_t>(keyframe)].features.id());
}

}  // namespace opp::mapping
