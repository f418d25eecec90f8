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

  bool fits(const Plane& plane, double gate_sigmas) const {
    return moments.squaredError(plane) <= gate_sigmas * gate_sigmas * effective_samples;
  }
  /// Standard deviation of the samples along a direction [m].
  double extent(const Eigen::Vector3d& direction) const {
    return std::sqrt(direction.dot(moments.scatter() * direction) / moments.weight());
  }
};

std::vector<Support> supportsOf(const MapState& map) {
  std::vector<Support> supports(map.landmarks.planes.size());
  for (const PlaneFactor& factor : map.factors.planes) {
    Support& support = supports[Index(factor.landmark)];
    support.moments.merge(
        transformed(map.keyframes[Index(factor.keyframe)].map_from_body, factor.moments_in_body));
    support.effective_samples += factor.effective_samples;
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

bool areOneSurface(const Support& a, const Plane& plane_a, const Support& b, const Plane& plane_b,
                   double gate_sigmas) {
  // Cheap test first: surfaces that do not even roughly face the same way are two.
  constexpr double kSameSide = 0.87;  // cos 30°
  if (a.moments.empty() || b.moments.empty() || plane_a.normal().dot(plane_b.normal()) < kSameSide)
    return false;
  if (!touch(a, b)) return false;
  PointMoments joint = a.moments;
  joint.merge(b.moments);
  const Plane plane = joint.fitPlane(joint.mean() + plane_a.normal());
  return a.fits(plane, gate_sigmas) && b.fits(plane, gate_sigmas);
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

}  // namespace

int mergeLandmarks(MapState& map, double gate_sigmas) {
  std::vector<Support> supports = supportsOf(map);
  int merged = 0;
  for (Index a = 0; a < supports.size(); ++a) {
    for (Index b = a + 1; b < supports.size(); ++b) {
      PlaneLandmark& older = map.landmarks.planes[a];
      if (!areOneSurface(supports[a], older.plane_in_map, supports[b],
                         map.landmarks.planes[b].plane_in_map, gate_sigmas)) {
        continue;
      }
      redirect(static_cast<int>(b), static_cast<int>(a), map);
      supports[a].moments.merge(supports[b].moments);
      supports[a].effective_samples += supports[b].effective_samples;
      supports[b] = {};
      const Eigen::Vector3d mean = supports[a].moments.mean();
      older.plane_in_map = supports[a].moments.fitPlane(mean + older.plane_in_map.normal());
      ++merged;
    }
  }
  if (merged > 0) removeDuplicates(map);
  return merged;
}

}  // namespace opp::mapping
