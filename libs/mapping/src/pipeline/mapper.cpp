// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/pipeline/mapper.h"

#include "opp/mapping/backend/optimize_map.h"
#include "opp/mapping/frontend/insert_keyframe.h"
#include "opp/mapping/frontend/merge_landmarks.h"

#include <algorithm>
#include <utility>

namespace opp::mapping {
Mapper::Mapper(const MapperParams& params) : params_(params), tracker_(params) {}

FrameResult Mapper::add(ScanFeatures scan, const std::optional<Eigen::Isometry3d>& odom_from_body) {
  if (scan.cloud_in_body.size() == 0) return {};
  if (map_.keyframes.empty()) return start(std::move(scan), odom_from_body);

  const double timestamp = scan.timestamp;
  const std::size_t index = scan.scan_index;
  const TrackResult track = tracker_.track(scan, odom_from_body, map_);
  FrameResult result{track.localized(), track.wants_keyframe, track.match.overlap, track.match.rms};
  if (!result.localized) return result;
  if (result.is_keyframe) {
    addKeyframe(std::move(scan), track.match);
    tracker_.correct(map_.keyframes.back().map_from_body);
    follow(timestamp, index, map_.keyframes.back().map_from_body);
  } else {
    follow(timestamp, index, track.match.map_from_body);
  }
  return result;
}

FrameResult Mapper::start(ScanFeatures scan,
                          const std::optional<Eigen::Isometry3d>& odom_from_body) {
  MatchResult match;
  match.map_from_body = initial_pose_;
  const double timestamp = scan.timestamp;
  const std::size_t index = scan.scan_index;
  tracker_.start({timestamp, initial_pose_}, odom_from_body);
  addKeyframe(std::move(scan), match);
  follow(timestamp, index, initial_pose_);
  return {true, true, 1.0, 0.0};
}

void Mapper::addKeyframe(ScanFeatures scan, const MatchResult& match) {
  const int id = insertKeyframe(std::move(scan), match, params_.primitives.sensor, map_);
  const int first_free = std::max(1, id + 1 - params_.backend.window);
  if (id > 0) optimize(first_free);
  if (mergeLandmarks(map_, params_.registration.plane_gate_sigmas) > 0 && id > 0)
    optimize(first_free);
  tracker_.setLocalMap(map_);
}

void Mapper::follow(double timestamp, std::size_t scan_index,
                    const Eigen::Isometry3d& map_from_body) {
  const Eigen::Isometry3d keyframe_from_map = map_.keyframes.back().map_from_body.inverse();
  followers_.push_back({timestamp, scan_index, static_cast<int>(map_.keyframes.size()) - 1,
                        keyframe_from_map * map_from_body});
}

void Mapper::optimize(int first_free) {
  std::vector<Eigen::Isometry3d> poses;
  for (const Keyframe& keyframe : map_.keyframes) poses.push_back(keyframe.map_from_body);
  std::vector<Plane> planes;
  for (const PlaneLandmark& landmark : map_.landmarks.planes)
    planes.push_back(landmark.plane_in_map);
  optimizeMap(map_.factors, first_free, params_.backend, poses, planes);
  for (std::size_t k = 0; k < poses.size(); ++k) map_.keyframes[k].map_from_body = poses[k];
  for (std::size_t k = 0; k < planes.size(); ++k) map_.landmarks.planes[k].plane_in_map = planes[k];
  updateCorners(map_.landmarks);
}

void Mapper::finish() {
  if (map_.keyframes.size() > 1) optimize(1);
}

Eigen::Isometry3d Mapper::poseOf(const Follower& follower) const {
  const Keyframe& keyframe = map_.keyframes[static_cast<std::size_t>(follower.keyframe)];
  return normalized(keyframe.map_from_body * follower.keyframe_from_body);
}

Trajectory Mapper::trajectory() const {
  Trajectory result;
  for (const Follower& follower : followers_)
    result.push_back({follower.timestamp, poseOf(follower)});
  return result;
}

std::map<std::size_t, Eigen::Isometry3d> Mapper::poses() const {
  std::map<std::size_t, Eigen::Isometry3d> result;
  for (const Follower& follower : followers_) result.emplace(follower.scan_index, poseOf(follower));
  return result;
}

}  // namespace opp::mapping
