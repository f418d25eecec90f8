// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frontend/shown_distortion.h"

#include "opp/geometry/median.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Whether each landmark was seen by more than one keyframe: else it fits what it was fitted to.
std::vector<bool> seenRepeatedly(const MapState& map) {
  std::vector<int> keyframe_of(map.landmarks.planes.size(), -1);
  std::vector<bool> repeatedly(keyframe_of.size(), false);
  for (const PlaneFactor& factor : map.factors.planes) {
    int& keyframe = keyframe_of[Index(factor.landmark)];
    if (keyframe >= 0 && keyframe != factor.keyframe) repeatedly[Index(factor.landmark)] = true;
    keyframe = factor.keyframe;
  }
  return repeatedly;
}

}  // namespace

SensorModel withShownDistortion(const SensorModel& sensor, const MapState& map) {
  const std::vector<bool> repeatedly = seenRepeatedly(map);
  std::vector<double> shares;  // of the mean square that the model's distortion would make
  for (const PlaneFactor& factor : map.factors.planes) {
    const PointMoments& seen = factor.moments_in_body;
    if (seen.empty() || !repeatedly[Index(factor.landmark)]) continue;
    const double expected = std::pow(sensor.distortion(seen.mean().norm()), 2) * seen.weight();
    if (!(expected > 0.0)) continue;
    const Eigen::Isometry3d& map_from_body = map.keyframes[Index(factor.keyframe)].map_from_body;
    const Plane& plane_in_map = map.landmarks.planes[Index(factor.landmark)].plane_in_map;
    const double error = seen.squaredError(transformed(map_from_body.inverse(), plane_in_map));
    shares.push_back(std::max(0.0, error - factor.effective_samples) / expected);
  }
  if (shares.empty()) return sensor;
  SensorModel shown = sensor;
  shown.distortion_quadratic *= std::sqrt(std::min(1.0, medianOf(std::move(shares))));
  return shown;
}

}  // namespace opp::mapping
