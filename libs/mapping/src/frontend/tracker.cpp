// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/tracker.h"

#include "opp/mapping/registration/align_globally.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace opp::mapping {
namespace {

/// Where a keyframe looks: the mean of what it saw.
Eigen::Vector3d viewCentre(const Keyframe& keyframe) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& point : keyframe.features.cloud_in_body.points)
    sum += point.cast<double>();
  return keyframe.map_from_body *
         Eigen::Vector3d(sum / static_cast<double>(keyframe.features.cloud_in_body.size()));
}

}  // namespace

std::string_view describe(TrackOutcome outcome) {
  switch (outcome) {
    case TrackOutcome::kLocalized:
      return "localized";
    case TrackOutcome::kEmptyScan:
      return "the scan is empty";
    case TrackOutcome::kNoMap:
      return "there is no map yet";
    case TrackOutcome::kLittleOverlap:
      return "too little of the scan agrees with the map";
  }
  return "";
}

Tracker::Tracker(const MapperParams& params) : params_(params), motion_(params.frontend) {}

void Tracker::start(const StampedPose& pose,
                    const std::optional<Eigen::Isometry3d>& odom_from_body) {
  motion_ = MotionModel(params_.frontend);
  motion_.update(pose, odom_from_body);
}

TrackResult Tracker::track(const ScanFeatures& scan,
                           const std::optional<Eigen::Isometry3d>& odom_from_body,
                           const MapState& map) {
  TrackResult result;
  if (!local_map_ || map.keyframes.empty()) return result;
  result.outcome = TrackOutcome::kEmptyScan;
  if (scan.cloud_in_body.size() == 0) return result;

  const Keyframe& newest = map.keyframes.back();
  result.match = localize(scan, motion_.predict(scan.timestamp, odom_from_body), newest);
  result.outcome = result.match.overlap >= params_.frontend.min_overlap
                       ? TrackOutcome::kLocalized
                       : TrackOutcome::kLittleOverlap;
  if (!result.localized()) return result;
  motion_.update({scan.timestamp, result.match.map_from_body}, odom_from_body);
  result.wants_keyframe = wantsKeyframe(result.match, newest);
  return result;
}

/// The ladder of DESIGN 3: prediction, then the last pose with no more known than how fast a body
/// moves, then no guess.
MatchResult Tracker::localize(const ScanFeatures& scan, const PosePrior& predicted,
                              const Keyframe& newest) const {
  MatchResult best = matchScan(scan, *local_map_, predicted, params_.registration);
  if (best.overlap >= params_.frontend.doubtful_overlap) return best;
  // A wrong pose can agree with a good part of a map: the floor fits at many places.
  MatchResult wide =
      matchScan(scan, *local_map_, motion_.lastPose(scan.timestamp), params_.registration);
  if (wide.overlap > best.overlap) best = std::move(wide);
  if (best.overlap >= params_.frontend.doubtful_overlap) return best;
  MatchResult global = relocalize(scan, newest);
  return global.overlap > best.overlap ? global : best;
}

MatchResult Tracker::relocalize(const ScanFeatures& scan, const Keyframe& newest) const {
  const GlobalAlignment alignment = alignGlobally(newest.features, scan, params_.global_alignment);
  if (alignment.outcome != AlignmentOutcome::kAligned) return {};
  // A start without weight: the alignment saw the same scan, so its information must not count
  // twice.
  PosePrior start;
  start.map_from_body = newest.map_from_body * alignment.target_from_source;
  return matchScan(scan, *local_map_, start, params_.registration);
}

bool Tracker::wantsKeyframe(const MatchResult& match, const Keyframe& newest) const {
  const Eigen::Isometry3d newest_from_now = newest.map_from_body.inverse() * match.map_from_body;
  return match.overlap < params_.frontend.keyframe_overlap ||
         rotationAngle(newest_from_now) > params_.frontend.keyframe_rotation;
}

void Tracker::setLocalMap(const MapState& map) {
  if (map.keyframes.empty()) {
    local_map_.reset();
    return;
  }
  const std::vector<int> ids =
      localKeyframes(map.keyframes, static_cast<std::size_t>(params_.frontend.local_keyframes));
  double spacing = 0.0;
  for (const int id : ids) {
    spacing = std::max(spacing,
                       map.keyframes[static_cast<std::size_t>(id)].features.cloud_in_body.spacing);
  }
  local_map_.emplace(spacing, params_.primitives.sensor, params_.registration);
  for (const int id : ids) {
    const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(id)];
    local_map_->insert(keyframe.features, keyframe.map_from_body, keyframe.landmark_of_plane);
  }
  std::vector<Plane> planes;
  for (const PlaneLandmark& landmark : map.landmarks.planes)
    planes.push_back(landmark.plane_in_map);
  local_map_->setLandmarks(std::move(planes));
}

std::vector<int> localKeyframes(const std::vector<Keyframe>& keyframes, std::size_t count) {
  if (keyframes.empty()) return {};
  const Eigen::Vector3d here = viewCentre(keyframes.back());
  std::vector<double> distance;
  for (const Keyframe& keyframe : keyframes)
    distance.push_back((viewCentre(keyframe) - here).norm());
  std::vector<int> ids(keyframes.size());
  std::iota(ids.begin(), ids.end(), 0);
  std::stable_sort(ids.begin(), ids.end(), [&](int a, int b) {
    return distance[static_cast<std::size_t>(a)] < distance[static_cast<std::size_t>(b)];
  });
  ids.resize(std::min(ids.size(), count));
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace opp::mapping
