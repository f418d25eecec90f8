// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/split_landmarks.h"

#include "opp/mapping/frontend/insert_keyframe.h"

#include "frontend/landmark_support.h"
#include "frontend/shown_distortion.h"

#include <algorithm>
#include <vector>

namespace opp::mapping {
namespace {

using Index = std::size_t;

struct Observation {
  PrimitiveObservation seen;
  LandmarkSupport support;
};

/// Of each landmark.
std::vector<std::vector<Observation>> observationsOf(const MapState& map) {
  std::vector<std::vector<Observation>> result(map.landmarks.planes.size());
  std::vector<int> planes(map.keyframes.size());
  for (const PlaneFactor& factor : map.factors.planes) {
    const int plane = planes[Index(factor.keyframe)]++;
    if (factor.moments_in_body.empty()) continue;
    result[Index(factor.landmark)].push_back({{factor.keyframe, plane}, supportOf(factor, map)});
  }
  return result;
}

/// Observations that one plane explains.
struct Set {
  std::vector<Observation> members;
  LandmarkSupport support;
  Plane plane;

  void add(const Observation& observation) {
    members.push_back(observation);
    support.merge(observation.support);
    plane = support.moments.fitPlane(support.moments.mean() + plane.normal());
  }
};

/// The set with the observation, if one plane explains both.
bool joins(const Observation& observation, const SensorModel& sensor, double gate_sigmas,
           Set& set) {
  Set joint = set;
  joint.add(observation);
  if (!explains(joint.plane, set.support, sensor, gate_sigmas) ||
      !explains(joint.plane, observation.support, sensor, gate_sigmas))
    return false;
  set = std::move(joint);
  return true;
}

std::vector<Set> agreeingSets(std::vector<Observation> observations, const Plane& plane,
                              const SensorModel& sensor, double gate_sigmas) {
  std::stable_sort(observations.begin(), observations.end(),
                   [](const Observation& a, const Observation& b) {
                     return a.support.moments.weight() > b.support.moments.weight();
                   });
  std::vector<Set> sets;
  for (const Observation& observation : observations) {
    const auto joined = std::find_if(sets.begin(), sets.end(), [&](Set& set) {
      return joins(observation, sensor, gate_sigmas, set);
    });
    if (joined != sets.end()) continue;
    sets.push_back({{}, {}, plane});
    sets.back().add(observation);
  }
  return sets;
}

void moveToNewLandmark(const Set& set, MapState& map) {
  const auto id = static_cast<int>(map.landmarks.planes.size());
  map.landmarks.planes.push_back({set.plane, {}});
  for (const Observation& observation : set.members) {
    Keyframe& keyframe = map.keyframes[Index(observation.seen.keyframe)];
    keyframe.landmark_of_plane[Index(observation.seen.primitive)] = id;
  }
}

}  // namespace

int splitLandmarks(MapState& map, const SensorModel& sensor, const BackendParams& params) {
  const SensorModel shown = withShownDistortion(sensor, map);
  const std::vector<std::vector<Observation>> observations = observationsOf(map);
  for (Index l = 0; l < observations.size(); ++l) {
    if (observations[l].size() < 2) continue;
    PlaneLandmark& landmark = map.landmarks.planes[l];
    const std::vector<Set> sets =
        agreeingSets(observations[l], landmark.plane_in_map, shown, params.kernel_width);
    if (sets.size() == 1) continue;
    landmark.plane_in_map = sets.front().plane;
    for (Index k = 1; k < sets.size(); ++k) moveToNewLandmark(sets[k], map);
  }
  const auto added = static_cast<int>(map.landmarks.planes.size() - observations.size());
  if (added > 0) relink(map);
  return added;
}

}  // namespace opp::mapping
