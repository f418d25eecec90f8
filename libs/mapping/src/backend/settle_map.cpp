// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/backend/settle_map.h"

#include "opp/mapping/backend/optimize_map.h"
#include "opp/mapping/frontend/insert_keyframe.h"
#include "opp/mapping/frontend/merge_landmarks.h"

namespace opp::mapping {
namespace {

void optimize(MapState& map, int first_free, const BackendParams& params) {
  std::vector<Eigen::Isometry3d> poses;
  for (const Keyframe& keyframe : map.keyframes) poses.push_back(keyframe.map_from_body);
  std::vector<Plane> planes;
  for (const PlaneLandmark& landmark : map.landmarks.planes)
    planes.push_back(landmark.plane_in_map);
  optimizeMap(map.factors, first_free, params, poses, planes);
  for (std::size_t k = 0; k < poses.size(); ++k) map.keyframes[k].map_from_body = poses[k];
  for (std::size_t k = 0; k < planes.size(); ++k) map.landmarks.planes[k].plane_in_map = planes[k];
  updateCorners(map.landmarks);
}

}  // namespace

void settleMap(MapState& map, int first_free, const MapperParams& params) {
  if (map.keyframes.size() < 2) return;
  optimize(map, first_free, params.backend);
  if (mergeLandmarks(map, params.backend.kernel_width) > 0)
    optimize(map, first_free, params.backend);
}

}  // namespace opp::mapping
