// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/associate_planes.h"

#include <algorithm>
#include <map>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Each scan plane's votes for the landmarks of the surfels that its points match.
struct Votes {
  std::map<int, int> of_landmark;
  int matched = 0;  ///< points that found a surfel, of a landmark or not
};

std::vector<Votes> vote(const std::vector<ScanPoint>& points,
                        const Eigen::Isometry3d& map_from_body, const LocalMap& map, Index planes) {
  std::vector<Votes> votes(planes);
  const Eigen::Isometry3f pose = map_from_body.cast<float>();
  for (const ScanPoint& p : points) {
    if (p.label < 0) continue;
    const Surfel* surfel =
        map.fine().surfaces.closest(pose * p.point_in_body, pose.linear() * p.normal_in_body);
    if (surfel == nullptr) continue;
    Votes& of_plane = votes[Index(p.label)];
    ++of_plane.matched;
    if (surfel->landmark >= 0) ++of_plane.of_landmark[surfel->landmark];
  }
  return votes;
}

/// The samples' root mean square distance to the landmark, over noise and distortion, is within the
/// gate.
bool fits(const ScanPlane& plane, const Plane& landmark_in_body, const SensorModel& sensor,
          double gate_sigmas) {
  const PointMoments& moments = plane.moments_in_body;
  const double distortion = sensor.distortion(moments.mean().norm());
  return moments.squaredError(landmark_in_body) <
         gate_sigmas * gate_sigmas * (plane.samples + distortion * distortion * moments.weight());
}

}  // namespace

void associatePlanes(const std::vector<ScanPoint>& points, const Eigen::Isometry3d& map_from_body,
                     const LocalMap& map, const RegistrationParams& params,
                     std::vector<ScanPlane>& planes) {
  const std::vector<Votes> votes = vote(points, map_from_body, map, planes.size());
  for (Index k = 0; k < planes.size(); ++k) {
    const auto best =
        std::max_element(votes[k].of_landmark.begin(), votes[k].of_landmark.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (best == votes[k].of_landmark.end() ||
        best->second < params.plane_vote_share * votes[k].matched) {
      continue;
    }
    const Plane& landmark = map.landmarkPlanes()[Index(best->first)];
    if (fits(planes[k], transformed(map_from_body.inverse(), landmark), map.sensor(),
             params.plane_gate_sigmas))
      planes[k].landmark = best->first;
  }
}

}  // namespace opp::mapping
