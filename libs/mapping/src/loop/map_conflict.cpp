// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/map_conflict.h"

#include "registration/scan_model.h"
#include "registration/verify_pose.h"

#include <algorithm>
#include <cstddef>

namespace opp::mapping {
namespace {

/// Keyframes that are looked at, about.
constexpr std::size_t kComparedKeyframes = 12;

/// The one whose view is nearest to `view`; null if none is within `reach`.
const Keyframe* nearestView(const KeyframeViews& keyframes, const Eigen::Vector3d& view,
                            double reach) {
  const Keyframe* nearest = nullptr;
  for (const Keyframe* keyframe : keyframes) {
    const double distance = (keyframe->viewCentre() - view).norm();
    if (distance >= reach) continue;
    reach = distance;
    nearest = keyframe;
  }
  return nearest;
}

}  // namespace

KeyframeViews viewsOf(const MapState& map) {
  KeyframeViews views;
  for (const Keyframe& keyframe : map.keyframes) views.push_back(&keyframe);
  return views;
}

std::optional<double> conflictOf(const KeyframeViews& a, const KeyframeViews& b,
                                 const Eigen::Isometry3d& a_from_b, const MapperParams& params) {
  const std::size_t step = std::max<std::size_t>(1, b.size() / kComparedKeyframes);
  int agreeing = 0, conflicting = 0;
  for (std::size_t k = 0; k < b.size(); k += step) {
    const Keyframe& of_b = *b[k];
    const Keyframe* of_a =
        nearestView(a, a_from_b * of_b.viewCentre(), params.loop.search_distance);
    if (of_a == nullptr) continue;
    const ScanModel target(of_a->features, params.primitives.sensor, params.global_alignment);
    const ScanModel source(of_b.features, params.primitives.sensor, params.global_alignment);
    const Eigen::Isometry3d target_from_source =
        of_a->map_from_body.inverse() * a_from_b * of_b.map_from_body;
    const Verification seen = verifyPose(target, source, target_from_source,
                                         params.loop.agree_translation, params.global_alignment);
    for (const Agreement* side : {&seen.of_source, &seen.of_target}) {
      agreeing += side->agreeing;
      conflicting += side->conflicting;
    }
  }
  const int both = agreeing + conflicting;
  if (both == 0) return std::nullopt;
  return static_cast<double>(conflicting) / both;
}

}  // namespace opp::mapping
