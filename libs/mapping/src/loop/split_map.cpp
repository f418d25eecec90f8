// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/split_map.h"

#include <algorithm>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// New id of each old one; −1: left out.
using Renumbering = std::vector<int>;

/// Numbers those of `count` things that `kept` approves of.
template <typename Kept>
Renumbering renumber(Index count, Kept kept) {
  Renumbering result(count, -1);
  int next = 0;
  for (Index k = 0; k < count; ++k) {
    if (kept(k)) result[k] = next++;
  }
  return result;
}

template <std::size_t N>
bool allKept(const std::array<int, N>& ids, const Renumbering& renumbered) {
  return std::all_of(ids.begin(), ids.end(), [&](int id) { return renumbered[Index(id)] >= 0; });
}

template <std::size_t N>
std::array<int, N> renumberedIds(std::array<int, N> ids, const Renumbering& renumbered) {
  for (int& id : ids) id = renumbered[Index(id)];
  return ids;
}

std::vector<PrimitiveObservation> observationsOf(const std::vector<PrimitiveObservation>& all,
                                                 const Renumbering& keyframes) {
  std::vector<PrimitiveObservation> result;
  for (PrimitiveObservation o : all) {
    o.keyframe = keyframes[Index(o.keyframe)];
    if (o.keyframe >= 0) result.push_back(o);
  }
  return result;
}

LandmarkMap landmarksOf(const LandmarkMap& all, const Renumbering& keyframes,
                        const Renumbering& planes) {
  LandmarkMap result;
  for (Index p = 0; p < all.planes.size(); ++p) {
    if (planes[p] < 0) continue;
    result.planes.push_back(
        {all.planes[p].plane_in_map, observationsOf(all.planes[p].observations, keyframes)});
  }
  for (const CornerLandmark& corner : all.corners) {
    auto observations = observationsOf(corner.observations, keyframes);
    if (observations.empty() || !allKept(corner.planes, planes)) continue;
    result.corners.push_back(
        {renumberedIds(corner.planes, planes), corner.position_in_map, std::move(observations)});
  }
  return result;
}

MapFactors factorsOf(const MapFactors& all, const Renumbering& keyframes,
                     const Renumbering& planes) {
  MapFactors result;
  for (PlaneFactor f : all.planes) {
    f.keyframe = keyframes[Index(f.keyframe)];
    if (f.keyframe < 0) continue;
    f.landmark = planes[Index(f.landmark)];
    result.planes.push_back(f);
  }
  for (RelativePoseFactor f : all.relative_poses) {
    f.first = keyframes[Index(f.first)];
    f.second = keyframes[Index(f.second)];
    if (f.first >= 0 && f.second >= 0) result.relative_poses.push_back(f);
  }
  for (const OrthogonalityFactor& f : all.orthogonalities) {
    if (allKept(f.landmarks, planes))
      result.orthogonalities.push_back({renumberedIds(f.landmarks, planes)});
  }
  for (const ParallelismFactor& f : all.parallelisms) {
    if (allKept(f.landmarks, planes))
      result.parallelisms.push_back({renumberedIds(f.landmarks, planes)});
  }
  return result;
}

/// Moves the kept keyframes out of `map`; the rest of it is copied.
MapState takeKeyframes(const Renumbering& keyframes, MapState& map) {
  const Renumbering planes = renumber(map.landmarks.planes.size(), [&](Index p) {
    const auto& seen = map.landmarks.planes[p].observations;
    return std::any_of(seen.begin(), seen.end(), [&](const PrimitiveObservation& o) {
      return keyframes[Index(o.keyframe)] >= 0;
    });
  });
  MapState part;
  part.landmarks = landmarksOf(map.landmarks, keyframes, planes);
  part.factors = factorsOf(map.factors, keyframes, planes);
  for (Index k = 0; k < map.keyframes.size(); ++k) {
    if (keyframes[k] < 0) continue;
    part.keyframes.push_back(std::move(map.keyframes[k]));
    for (int& landmark : part.keyframes.back().landmark_of_plane) {
      if (landmark >= 0) landmark = planes[Index(landmark)];
    }
  }
  for (const KeyframeLink& link : map.links) {
    const int first = keyframes[Index(link.first)], second = keyframes[Index(link.second)];
    if (first >= 0 && second >= 0) part.links.push_back({first, second, link.variance});
  }
  for (LocalizedScan scan : map.scans) {
    scan.keyframe = keyframes[Index(scan.keyframe)];
    if (scan.keyframe < 0) continue;
    if (scan.open && scan.open->next >= 0) scan.open->next = keyframes[Index(scan.open->next)];
    part.scans.push_back(scan);
  }
  return part;
}

}  // namespace

std::vector<MapState> splitMap(MapState&& map, const std::vector<int>& sets) {
  std::vector<MapState> parts;
  const int count = sets.empty() ? 0 : 1 + *std::max_element(sets.begin(), sets.end());
  if (count == 1) {
    parts.push_back(std::move(map));
    return parts;
  }
  for (int set = 0; set < count; ++set) {
    const Renumbering keyframes = renumber(sets.size(), [&](Index k) { return sets[k] == set; });
    parts.push_back(takeKeyframes(keyframes, map));
  }
  const auto largest = std::max_element(
      parts.begin(), parts.end(),
      [](const MapState& a, const MapState& b) { return a.scans.size() < b.scans.size(); });
  if (largest != parts.end()) largest->loop_closures = map.loop_closures;
  return parts;
}

}  // namespace opp::mapping
