// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/passage_watch.h"

#include "registration/observability.h"

#include <utility>

namespace opp::mapping {
namespace {

int newestOf(const MapState& map) { return static_cast<int>(map.keyframes.size()) - 1; }

Eigen::Isometry3d fromMap(const MapState& map, int keyframe) {
  return map.keyframes[static_cast<std::size_t>(keyframe)].map_from_body.inverse();
}

}  // namespace

PassedScan PassageWatch::passed(const FollowedScan& scan, int keyframe, const MapState& map) {
  const MotionStep step = since_keyframe_.update(scan.pose, scan.odom_from_body, scan.information);
  return {scan.scan, inFrame(fromMap(map, keyframe), step)};
}

void PassageWatch::addScan(const FollowedScan& scan, MapState& map) {
  PassedScan passed_scan = passed(scan, newestOf(map), map);
  if (!scan.is_open) {
    endOpenScans(scan, passed_scan, map);
    begins_ = passed_scan.step.found;
    return;
  }
  if (scan.scan) {
    map.scans[*scan.scan].open.emplace().covariance = passed_scan.step.found.poseCovariance();
  }
  open_.push_back(std::move(passed_scan));
}

void PassageWatch::addKeyframe(const FollowedScan& scan, const PosePrior& tied, MapState& map) {
  PassedScan passed_scan = passed(scan, newestOf(map) - 1, map);
  if (!scan.is_open) return endOpenScans(scan, passed_scan, map);
  if (is_known_) {
    closePassage(map);
    passage_.emplace();
  }
  is_known_ = false;
  open_.push_back(std::move(passed_scan));
  passage_->reach({newestOf(map), scan.pose.timestamp, tied, begins_, std::exchange(open_, {})});
  passage_->tighten(params_, map);
}

void PassageWatch::endOpenScans(const FollowedScan& known, const PassedScan& passed_scan,
                                MapState& map) {
  if (!open_.empty()) settlePassed(std::exchange(open_, {}), passed_scan, map);
  is_known_ = true;
  if (!passage_) return;
  const Eigen::Isometry3d end_from_map = fromMap(map, passage_->keyframe());
  passage_->follow({known.pose.timestamp, end_from_map * known.pose.map_from_body},
                   informationIn(end_from_map.linear().transpose(), known.information));
  if (passage_->isFollowed()) closePassage(map);
}

void PassageWatch::closePassage(MapState& map) {
  if (passage_) passage_->tighten(params_, map);
  passage_.reset();
}

void PassageWatch::beginAt(const MotionModel& motion) {
  since_keyframe_ = motion;
  since_keyframe_.beginAtLastPose();
  const MotionState& state = since_keyframe_.state();
  begins_ = inFrame(state.map_from_body.inverse(), state);
}

void PassageWatch::end(MapState& map) {
  closePassage(map);
  open_.clear();
  is_known_ = true;
}

}  // namespace opp::mapping
