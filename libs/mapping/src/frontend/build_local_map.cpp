// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/build_local_map.h"

#include "frontend/shown_distortion.h"

#include <algorithm>
#include <utility>

namespace opp::mapping {

LocalMap localMapOf(const MapState& map, const std::vector<int>& keyframes,
                    const MapperParams& params) {
  double spacing = 0.0;
  for (const int id : keyframes) {
    spacing = std::max(spacing,
                       map.keyframes[static_cast<std::size_t>(id)].features.cloud_in_body.spacing);
  }
  LocalMap local(spacing, withShownDistortion(params.primitives.sensor, map), params.registration);
  for (const int id : keyframes) {
    const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(id)];
    local.insert(keyframe.features, keyframe.map_from_body, keyframe.landmark_of_plane);
  }
  std::vector<Plane> planes;
  for (const PlaneLandmark& landmark : map.landmarks.planes)
    planes.push_back(landmark.plane_in_map);
  local.setLandmarks(std::move(planes));
  return local;
}

}  // namespace opp::mapping
