// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/merge_landmarks.h"

#include "opp/mapping/frontend/insert_keyframe.h"

#include "frontend/landmark_support.h"
#include "frontend/shown_distortion.h"

#include <numeric>
#include <vector>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Whether they can be parts of one surface that no keyframe saw whole.
bool mayContinue(const LandmarkSupport& a, const LandmarkSupport& b) {
  return touch(a, b) && !seenTogether(a, b);
}

/// Joins all pairs, of ids a < b, for which onePlane(a, b, common plane) holds.
template <typename OnePlane>
int mergePairs(MapState& map, std::vector<LandmarkSupport>& supports, const OnePlane& onePlane) {
  std::vector<int> joined_with(supports.size());
  std::iota(joined_with.begin(), joined_with.end(), 0);
  int merged = 0;
  for (Index a = 0; a < supports.size(); ++a) {
    for (Index b = a + 1; b < supports.size(); ++b) {
      PlaneLandmark& older = map.landmarks.planes[a];
      if (supports[a].moments.empty() || supports[b].moments.empty() ||
          !faceAlike(older.plane_in_map, map.landmarks.planes[b].plane_in_map))
        continue;
      PointMoments joint = supports[a].moments;
      joint.merge(supports[b].moments);
      const Plane common = joint.fitPlane(joint.mean() + older.plane_in_map.normal());
      if (!onePlane(a, b, common)) continue;
      joined_with[b] = static_cast<int>(a);  // no chains: nothing joins b any more
      supports[a].merge(supports[b]);
      supports[b] = {};
      older.plane_in_map = common;
      ++merged;
    }
  }
  if (merged > 0) joinLandmarks(joined_with, map);
  return merged;
}

}  // namespace

void joinLandmarks(const std::vector<int>& joined_with, MapState& map) {
  for (Keyframe& keyframe : map.keyframes) {
    for (int& landmark : keyframe.landmark_of_plane) landmark = joined_with[Index(landmark)];
  }
  relink(map);
}

int mergeLandmarks(MapState& map, double gate_sigmas) {
  std::vector<LandmarkSupport> supports = supportsOf(map);
  return mergePairs(map, supports, [&](Index a, Index b, const Plane& common) {
    return mayContinue(supports[a], supports[b]) && fits(supports[a], common, gate_sigmas) &&
           fits(supports[b], common, gate_sigmas);
  });
}

int unifyPlanes(MapState& map, const SensorModel& sensor, const BackendParams& params) {
  const SensorModel shown = withShownDistortion(sensor, map);
  std::vector<LandmarkSupport> supports = supportsOf(map);
  return mergePairs(map, supports, [&](Index a, Index b, const Plane& common) {
    const auto distorted = [&](Index k) {
      return fitsDistorted(supports[k], map.landmarks.planes[k].plane_in_map, common, shown,
                           params.kernel_width);
    };
    return coplanar(supports[a], supports[b], common, params.coplanar_resolution) ||
           (mayContinue(supports[a], supports[b]) && distorted(a) && distorted(b));
  });
}

}  // namespace opp::mapping
