// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/merge_landmarks.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// All samples of a landmark in the map's frame.
struct Support {
  PointMoments moments;
  double effective_samples = 0.0;
  double mean_range = 0.0;  ///< from the keyframes to what they saw [m], weighted as the samples
  std::set<int> keyframes;  ///< that saw it

  void merge(const Support& other) {
    const double weight = moments.weight() + other.moments.weight();
    mean_range =
        (mean_range * moments.weight() + other.mean_range * other.moments.weight()) / weight;
    moments.merge(other.moments);
    effective_samples += other.effective_samples;
    keyframes.insert(other.keyframes.begin(), other.keyframes.end());
  }
  /// Standard deviation of the samples along a direction [m].
  double extent(const Eigen::Vector3d& direction) const {
    return std::sqrt(direction.dot(moments.scatter() * direction) / moments.weight());
  }
};

std::vector<Support> supportsOf(const MapState& map) {
  std::vector<Support> supports(map.landmarks.planes.size());
  for (const PlaneFactor& factor : map.factors.planes) {
    if (factor.moments_in_body.empty()) continue;
    const Keyframe& keyframe = map.keyframes[Index(factor.keyframe)];
    supports[Index(factor.landmark)].merge(
        {transformed(keyframe.map_from_body, factor.moments_in_body),
         factor.effective_samples,
         factor.moments_in_body.mean().norm(),
         {factor.keyframe}});
  }
  return supports;
}

/// Whether two patches in one plane touch. An even patch reaches √3 standard deviations from its
/// centre; a quarter more allows for what occlusion leaves out between them.
bool touch(const Support& a, const Support& b) {
  constexpr double kReach = 1.25 * 1.7320508;
  const Eigen::Vector3d between = b.moments.mean() - a.moments.mean();
  const double distance = between.norm();
  if (distance < 1e-9) return true;
  const Eigen::Vector3d direction = between / distance;
  return distance <= kReach * (a.extent(direction) + b.extent(direction));
}

/// Whether two landmarks can be one surface at all: they roughly face the same way and touch.
bool comparable(const Support& a, const Plane& plane_a, const Support& b, const Plane& plane_b) {
  constexpr double kSameSide = 0.87;  // cos 30°
  return !a.moments.empty() && !b.moments.empty() &&
         plane_a.normal().dot(plane_b.normal()) >= kSameSide && touch(a, b);
}

/// Whether the samples lie in a plane to within their noise.
bool fits(const Support& part, const Plane& common, double gate_sigmas) {
  return part.moments.squaredError(common) <= gate_sigmas * gate_sigmas * part.effective_samples;
}

/// Whether distortion may be all that sets a landmark apart from a common plane.
bool fitsDistorted(const Support& part, const Plane& own, const Plane& common,
                   const SensorModel& sensor, double gate_sigmas) {
  const double bend = gate_sigmas * sensor.distortion(part.mean_range);
  const double tilt = gate_sigmas * sensor.distortionSlope(part.mean_range);
  return part.moments.squaredError(common) - part.moments.squaredError(own) <=
             bend * bend * part.moments.weight() &&
         own.normal().dot(common.normal()) >= std::cos(std::min(tilt, 1.0));
}

bool seenTogether(const Support& a, const Support& b) {
  return std::any_of(a.keyframes.begin(), a.keyframes.end(),
                     [&](int keyframe) { return b.keyframes.count(keyframe) > 0; });
}

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

/// Joins all pairs for which oneSurface(a, b, common plane) holds; the first arguments are indices
/// into the list of supports.
template <typename OneSurface>
int mergePairs(MapState& map, std::vector<Support>& supports, const OneSurface& oneSurface) {
  int merged = 0;
  for (Index a = 0; a < supports.size(); ++a) {
    for (Index b = a + 1; b < supports.size(); ++b) {
      PlaneLandmark& older = map.landmarks.planes[a];
      if (!comparable(supports[a], older.plane_in_map, supports[b],
                      map.landmarks.planes[b].plane_in_map)) {
        continue;
      }
      PointMoments joint = supports[a].moments;
      joint.merge(supports[b].moments);
      const Plane common = joint.fitPlane(joint.mean() + older.plane_in_map.normal());
      if (!oneSurface(a, b, common)) continue;
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
  std::vector<Support> supports = supportsOf(map);
  return mergePairs(map, supports, [&](Index a, Index b, const Plane& common) {
    return fits(supports[a], common, gate_sigmas) && fits(supports[b], common, gate_sigmas);
  });
}

int mergeDistortedLandmarks(MapState& map, const SensorModel& sensor, double gate_sigmas) {
  std::vector<Support> supports = supportsOf(map);
  return mergePairs(map, supports, [&](Index a, Index b, const Plane& common) {
    if (seenTogether(supports[a], supports[b])) return false;
    return fitsDistorted(supports[a], map.landmarks.planes[a].plane_in_map, common, sensor,
                         gate_sigmas) &&
           fitsDistorted(supports[b], map.landmarks.planes[b].plane_in_map, common, sensor,
                         gate_sigmas);
  });
}

}  // namespace opp::mapping
