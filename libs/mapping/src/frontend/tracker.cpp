// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/tracker.h"

#include "opp/mapping/registration/align_globally.h"

#include <utility>

namespace opp::mapping {

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
  const GlobalAlignment alignment =
      alignGlobally(newest.features, scan, params_.primitives.sensor, params_.global_alignment);
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

}  // namespace opp::mapping
