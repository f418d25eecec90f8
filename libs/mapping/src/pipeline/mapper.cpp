// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/pipeline/mapper.h"

#include "opp/mapping/backend/optimize_map.h"
#include "opp/mapping/frontend/insert_keyframe.h"
#include "opp/mapping/frontend/merge_landmarks.h"
#include "opp/mapping/registration/align_globally.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace opp::mapping {
namespace {

/// Where a keyframe looks: the mean of what it saw. Tells nearness of views for cameras and lidars
/// alike.
Eigen::Vector3d viewCentre(const Keyframe& keyframe) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& point : keyframe.features.cloud_in_body.points)
    sum += point.cast<double>();
  return keyframe.map_from_body *
         Eigen::Vector3d(sum / static_cast<double>(keyframe.features.cloud_in_body.size()));
}

}  // namespace

Mapper::Mapper(const MapperParams& params) : params_(params), motion_(params.frontend) {}

FrameResult Mapper::add(ScanFeatures scan, const std::optional<Eigen::Isometry3d>& odom_from_body) {
  if (scan.cloud_in_body.size() == 0) return {};
  if (map_.keyframes.empty()) return start(std::move(scan), odom_from_body);

  const double timestamp = scan.timestamp;
  const std::size_t index = scan.scan_index;
  const PosePrior prior = motion_.predict(timestamp, odom_from_body);
  const MatchResult match = localize(scan, prior);
  FrameResult result{match.overlap >= params_.frontend.min_overlap, false, match.overlap,
                     match.rms};
  if (!result.localized) return result;

  motion_.update({timestamp, match.map_from_body}, odom_from_body);
  result.is_keyframe = wantsKeyframe(match);
  if (result.is_keyframe) {
    addKeyframe(std::move(scan), match);
    motion_.correct(map_.keyframes.back().map_from_body);
    follow(timestamp, index, map_.keyframes.back().map_from_body);
  } else {
    follow(timestamp, index, match.map_from_body);
  }
  return result;
}

FrameResult Mapper::start(ScanFeatures scan,
                          const std::optional<Eigen::Isometry3d>& odom_from_body) {
  MatchResult match;
  match.map_from_body = initial_pose_;
  const double timestamp = scan.timestamp;
  const std::size_t index = scan.scan_index;
  motion_.update({timestamp, initial_pose_}, odom_from_body);
  addKeyframe(std::move(scan), match);
  follow(timestamp, index, initial_pose_);
  return {true, true, 1.0, 0.0};
}

/// The ladder of DESIGN 3: prediction, then the last pose with no more known than how fast a body
/// moves, then no guess.
MatchResult Mapper::localize(const ScanFeatures& scan, const PosePrior& predicted) const {
  MatchResult best = matchScan(scan, *local_map_, predicted, params_.registration);
  if (best.overlap >= params_.frontend.doubtful_overlap) return best;
  // A wrong pose can agree with a good part of a map: the floor fits at many places.
  MatchResult wide =
      matchScan(scan, *local_map_, motion_.lastPose(scan.timestamp), params_.registration);
  if (wide.overlap > best.overlap) best = std::move(wide);
  if (best.overlap >= params_.frontend.doubtful_overlap) return best;
  MatchResult global = relocalize(scan);
  return global.overlap > best.overlap ? global : best;
}

MatchResult Mapper::relocalize(const ScanFeatures& scan) const {
  const Keyframe& keyframe = map_.keyframes.back();
  const GlobalAlignment alignment =
      alignGlobally(keyframe.features, scan, params_.global_alignment);
  if (alignment.outcome != AlignmentOutcome::kAligned) return {};
  // A start without weight: the alignment saw the same scan, so its information must not count
  // twice.
  PosePrior start;
  start.map_from_body = keyframe.map_from_body * alignment.target_from_source;
  return matchScan(scan, *local_map_, start, params_.registration);
}

bool Mapper::wantsKeyframe(const MatchResult& match) const {
  const Eigen::Isometry3d last_from_now =
      map_.keyframes.back().map_from_body.inverse() * match.map_from_body;
  return match.overlap < params_.frontend.keyframe_overlap ||
         rotationAngle(last_from_now) > params_.frontend.keyframe_rotation;
}

void Mapper::addKeyframe(ScanFeatures scan, const MatchResult& match) {
  const int id = insertKeyframe(std::move(scan), match, params_.primitives.sensor, map_);
  const int first_free = std::max(1, id + 1 - params_.backend.window);
  if (id > 0) optimize(first_free);
  if (mergeLandmarks(map_, params_.registration.plane_gate_sigmas) > 0 && id > 0)
    optimize(first_free);
  rebuildLocalMap();
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

std::vector<int> Mapper::localKeyframes() const {
  const Eigen::Vector3d here = viewCentre(map_.keyframes.back());
  std::vector<double> distance;
  for (const Keyframe& keyframe : map_.keyframes)
    distance.push_back((viewCentre(keyframe) - here).norm());
  std::vector<int> ids(map_.keyframes.size());
  std::iota(ids.begin(), ids.end(), 0);
  std::stable_sort(ids.begin(), ids.end(), [&](int a, int b) {
    return distance[static_cast<std::size_t>(a)] < distance[static_cast<std::size_t>(b)];
  });
  if (ids.size() > static_cast<std::size_t>(params_.frontend.local_keyframes)) {
    ids.resize(static_cast<std::size_t>(params_.frontend.local_keyframes));
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

void Mapper::rebuildLocalMap() {
  const std::vector<int> ids = localKeyframes();
  double spacing = 0.0;
  for (const int id : ids) {
    spacing = std::max(spacing,
                       map_.keyframes[static_cast<std::size_t>(id)].features.cloud_in_body.spacing);
  }
  local_map_.emplace(spacing, params_.primitives.sensor, params_.registration);
  for (const int id : ids) {
    const Keyframe& keyframe = map_.keyframes[static_cast<std::size_t>(id)];
    local_map_->insert(keyframe.features, keyframe.map_from_body, keyframe.landmark_of_plane);
  }
  std::vector<Plane> planes;
  for (const PlaneLandmark& landmark : map_.landmarks.planes)
    planes.push_back(landmark.plane_in_map);
  local_map_->setLandmarks(std::move(planes));
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
