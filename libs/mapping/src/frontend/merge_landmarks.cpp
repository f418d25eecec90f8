// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/merge_landmarks.h"

#include "frontend/landmark_support.h"
#include "frontend/shown_distortion.h"

#include <algorithm>
#include <set>
#include <vector>

namespace opp::mapping {
namespace {

using Index = std::size_t;

template <typename Factor>
void redirectPairs(int from, int to, std::vector<Factor>& factors) {
  for (Factor& factor : factors) {
    std::replace(factor.landmarks.begin(), factor.landmarks.end(), from, to);
    std::sort(factor.landmarks.begin(), factor.landmarks.end());
  }
}

void redirect(int from, int to, MapState& map) {
  for (PlaneFactor& factor : map.factors.planes) {
    if (factor.landmark == from) factor.landmark = to;
  }
  for (Keyframe& keyframe : map.keyframes) {
    std::replace(keyframe.landmark_of_plane.begin(), keyframe.landmark_of_plane.end(), from, to);
  }
  redirectPairs(from, to, map.factors.orthogonalities);
  redirectPairs(from, to, map.factors.parallelisms);
  for (CornerLandmark& corner : map.landmarks.corners) {
    std::replace(corner.planes.begin(), corner.planes.end(), from, to);
    std::sort(corner.planes.begin(), corner.planes.end());
  }
  auto& source = map.landmarks.planes[Index(from)].observations;
  auto& target = map.landmarks.planes[Index(to)].observations;
  target.insert(target.end(), source.begin(), source.end());
  std::stable_sort(target.begin(), target.end(),
                   [](const PrimitiveObservation& a, const PrimitiveObservation& b) {
                     return a.keyframe < b.keyframe;
                   });
  source.clear();
}

/// Keeps the first of equal pairs and no pair of a landmark with itself.
template <typename Factor>
void removeDuplicatePairs(std::vector<Factor>& factors) {
  std::set<std::array<int, 2>> pairs;
  factors.erase(std::remove_if(factors.begin(), factors.end(),
                               [&](const Factor& f) {
                                 return f.landmarks[0] == f.landmarks[1] ||
                                        !pairs.insert(f.landmarks).second;
                               }),
                factors.end());
}

/// Joining planes makes some pairs and corners the same, and some join a plane with itself.
void removeDuplicates(MapState& map) {
  removeDuplicatePairs(map.factors.orthogonalities);
  removeDuplicatePairs(map.factors.parallelisms);
  std::vector<CornerLandmark> corners;
  for (CornerLandmark& corner : map.landmarks.corners) {
    if (corner.planes[0] == corner.planes[1] || corner.planes[1] == corner.planes[2]) continue;
    const auto same = std::find_if(corners.begin(), corners.end(), [&](const CornerLandmark& c) {
      return c.planes == corner.planes;
    });
    if (same == corners.end()) {
      corners.push_back(std::move(corner));
    } else {
      same->observations.insert(same->observations.end(), corner.observations.begin(),
                                corner.observations.end());
    }
  }
  map.landmarks.corners = std::move(corners);
}

/// Joins all pairs, of ids a < b, for which onePlane(a, b, common plane) holds.
template <typename OnePlane>
int mergePairs(MapState& map, std::vector<LandmarkSupport>& supports, const OnePlane& onePlane) {
  int merged = 0;
  for (Index a = 0; a < supports.size(); ++a) {
    for (Index b = a + 1; b < supports.size(); ++b) {
      // Cheap test first: surfaces that do not even roughly face the same way are two.
      constexpr double kSameSide = 0.87;  // cos 30°
      PlaneLandmark& older = map.landmarks.planes[a];
      const Eigen::Vector3d& normal = older.plane_in_map.normal();
      if (supports[a].moments.empty() || supports[b].moments.empty() ||
          normal.dot(map.landmarks.planes[b].plane_in_map.normal()) < kSameSide)
        continue;
      PointMoments joint = supports[a].moments;
      joint.merge(supports[b].moments);
      const Plane common = joint.fitPlane(joint.mean() + normal);
      if (!onePlane(a, b, common)) continue;
      redirect(static_cast<int>(b), static_cast<int>(a), map);
      supports[a].merge(supports[b]);
      supports[b] = {};
      older.plane_in_map = common;
      ++merged;
    }
  }
  if (merged > 0) removeDuplicates(map);
  return merged;
}

}  // namespace

int mergeLandmarks(MapState& map, double gate_sigmas) {
  std::vector<LandmarkSupport> supports = supportsOf(map);
  return mergePairs(map, supports, [&](Index a, Index b, const Plane& common) {
    return touch(supports[a], supports[b]) && !seenTogether(supports[a], supports[b]) &&
           fits(supports[a], common, gate_sigmas) && fits(supports[b], common, gate_sigmas);
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
           (touch(supports[a], supports[b]) && !seenTogether(supports[a], supports[b]) &&
            distorted(a) && distorted(b));
  });
}

}  // namespace opp::mapping
