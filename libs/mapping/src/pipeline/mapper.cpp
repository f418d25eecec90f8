// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/pipeline/mapper.h"

#include "opp/mapping/backend/settle_map.h"
#include "opp/mapping/frontend/add_views.h"
#include "opp/mapping/frontend/adopt_views.h"
#include "opp/mapping/frontend/build_local_map.h"
#include "opp/mapping/frontend/insert_keyframe.h"
#include "opp/mapping/frontend/merge_covered.h"
#include "opp/mapping/frontend/merge_landmarks.h"
#include "opp/mapping/frontend/split_landmarks.h"
#include "opp/mapping/loop/close_loose_ties.h"
#include "opp/mapping/loop/join_parts.h"
#include "opp/mapping/loop/keyframe_graph.h"
#include "opp/mapping/loop/level_ties.h"
#include "opp/mapping/loop/match_place.h"
#include "opp/mapping/loop/split_map.h"
#include "opp/mapping/loop/tie_parts.h"
#include "opp/mapping/loop/tied_sets.h"

#include "registration/observability.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <utility>

namespace opp::mapping {
namespace {

/// A scan that fixes its pose in every direction can found a map: its normals spread over space.
bool canFoundMap(const OrientedCloud& cloud, double min_spread) {
  if (cloud.size() == 0) return false;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& normal : cloud.normals) {
    const Eigen::Vector3d n = normal.cast<double>();
    sum += n * n.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] >= min_spread * static_cast<double>(cloud.size());
}

/// Leaves out scans that motion alone places, and so loosely that their poses would be invented.
void dropLooseScans(double max_variance, MapState& map) {
  const auto isLoose = [&](const LocalizedScan& scan) {
    return scan.open &&
           viewVariance(scan.open->next < 0 ? scan.open->covariance : scan.open->covariance_between,
                        map.keyframes[static_cast<std::size_t>(scan.keyframe)]) > max_variance;
  };
  map.scans.erase(std::remove_if(map.scans.begin(), map.scans.end(), isLoose), map.scans.end());
}

}  // namespace

Mapper::Mapper(const MapperParams& params)
    : params_(params), tracker_(params), loop_closer_(params), passages_(params.frontend) {}

const MapState& Mapper::map() const { return parts_.empty() ? empty_ : parts_.front().map; }

FrameResult Mapper::add(ScanFeatures scan, const std::optional<Eigen::Isometry3d>& odom_from_body) {
  if (!continues_) return begin(std::move(scan), odom_from_body);
  const TrackResult track = tracker_.track(scan, odom_from_body, active());
  FrameResult result{track.localized(), track.wants_keyframe, track.match.overlap, track.match.rms};
  if (!track.localized() && track.outcome != TrackOutcome::kUnobserved) {
    // Once its place is forgotten a body is not looked for any more: nothing is worth waiting for.
    const bool forgotten = track.outcome == TrackOutcome::kForgotten;
    if (++lost_in_a_row_ < params_.loop.lost_scans && !forgotten) return result;
    return begin(std::move(scan), odom_from_body);
  }
  lost_in_a_row_ = 0;
  FollowedScan followed = {{scan.timestamp, track.match.map_from_body},
                           odom_from_body,
                           track.match.information,
                           isOpen(track.match),
                           std::nullopt};
  // What comes after such a keyframe is matched with it alone: it is put off while the map before
  // explains most of what is seen.
  if (followed.is_open && track.match.overlap >= params_.frontend.open_keyframe_overlap)
    result.is_keyframe = false;
  // A body past a bare wall is followed until it sees again what it knows, or enough of what is new
  // to go on from there: the map knows how loosely the two are tied, see `finish`.
  if (!track.localized())
    result.localized = result.is_keyframe =
        result.is_keyframe && canFoundMap(scan.cloud_in_body, params_.loop.min_normal_spread);
  if (result.is_keyframe) {
    addTracked(std::move(scan), track, std::move(followed));
    return result;
  }
  if (result.localized) followed.scan = follow(scan, track.match);
  passages_.addScan(followed, active());
  return result;
}

FrameResult Mapper::begin(ScanFeatures scan,
                          const std::optional<Eigen::Isometry3d>& odom_from_body) {
  // The very first scan of a session founds a map whatever it shows: there is nothing to wait for.
  if (scan.cloud_in_body.size() == 0) return {};
  if (continues_ && !canFoundMap(scan.cloud_in_body, params_.loop.min_normal_spread)) return {};
  if (!parts_.empty()) passages_.end(active());
  MapPart part(next_part_++, params_.loop);
  if (continues_) {
    if (const auto beginning = expectedBeginning(scan, odom_from_body))
      part.history.expect(*beginning);
  }
  parts_.push_back(std::move(part));
  MatchResult match;
  if (parts_.size() == 1) match.map_from_body = initial_pose_;
  continues_ = true;
  lost_in_a_row_ = 0;
  loop_closer_.reset();
  local_.clear();
  tracker_.start({scan.timestamp, match.map_from_body}, odom_from_body);
  insert(std::move(scan), match);
  settleNewest();
  return {true, true, 1.0, 0.0};
}

std::optional<ExpectedBeginning> Mapper::expectedBeginning(
    const ScanFeatures& scan, const std::optional<Eigen::Isometry3d>& odom_from_body) const {
  const auto expected = tracker_.expected(scan.timestamp, odom_from_body);
  const MapState& map = parts_.back().map;
  if (!expected || map.scans.empty()) return std::nullopt;
  const LocalizedScan& last = map.scans.back();
  const Eigen::Isometry3d last_from_map = poseOf(map, last).inverse();
  return ExpectedBeginning{
      last.id(), scan.id(), last_from_map * expected->map_from_body,
      informationIn(last_from_map.linear().transpose(), expected->information)};
}

void Mapper::insert(ScanFeatures scan, const MatchResult& match) {
  MapState& map = active();
  const int id = insertKeyframe(std::move(scan), match, params_.primitives.sensor, map);
  const Keyframe& keyframe = map.keyframes.back();
  map.scans.push_back({keyframe.features.timestamp, keyframe.features.session,
                       keyframe.features.scan_index, id, Eigen::Isometry3d::Identity()});
  parts_.back().index.add(keyframe.features.primitives_in_body);
  linkKeyframe(local_, match.covariance, params_.loop, map);
}

void Mapper::settleNewest() {
  MapState& map = active();
  const int newest = static_cast<int>(map.keyframes.size()) - 1;
  settleMap(map, std::max(1, newest + 1 - params_.backend.window), params_);
  if (params_.loop.close_loops) loop_closer_.close(map);
  local_ = connectedViews(active(), newest, params_.frontend.local_keyframes, params_);
  tracker_.setLocalMap(localMapOf(active(), local_, params_));
  tracker_.correct(active().keyframes.back().map_from_body);
  passages_.beginAt(tracker_.motion());
}

bool Mapper::isOpen(const MatchResult& match) const {
  const MapState& map = parts_.back().map;
  const int newest = static_cast<int>(map.keyframes.size()) - 1;
  return viewVariance(covarianceOf(match.information), map.keyframes.back()) >
         connectedVariance(map, newest, params_);
}

std::size_t Mapper::follow(const ScanFeatures& scan, const MatchResult& match) {
  MapState& map = active();
  Keyframe& keyframe = map.keyframes.back();
  const Eigen::Isometry3d keyframe_from_body =
      keyframe.map_from_body.inverse() * match.map_from_body;
  map.scans.push_back({scan.timestamp, scan.session, scan.scan_index,
                       static_cast<int>(map.keyframes.size()) - 1, keyframe_from_body});
  if (viewVariance(match.covariance, keyframe) <= maxOpenVariance())
    addViews(scan, match.planes, keyframe_from_body, params_.primitives.sensor, params_.planar.cell,
             keyframe);
  return map.scans.size() - 1;
}

void Mapper::addTracked(ScanFeatures scan, const TrackResult& track, FollowedScan followed) {
  const Eigen::Isometry3d first_from_map = active().keyframes.back().map_from_body.inverse();
  insert(std::move(scan), track.match);
  followed.scan = active().scans.size() - 1;
  const PosePrior tied = {
      first_from_map * track.match.map_from_body,
      informationIn(first_from_map.linear().transpose(), track.motion_information)};
  passages_.addKeyframe(followed, tied, active());
  settleNewest();
}

double Mapper::maxOpenVariance() const {
  return params_.loop.loosest_tie * params_.loop.loosest_tie;
}

void Mapper::splitParts() {
  std::vector<MapPart> parts;
  for (MapPart& part : parts_) {
    if (params_.loop.close_loops) closeLooseTies(maxOpenVariance(), params_, part.map);
    const std::vector<int> sets = tiedSets(part.map, maxOpenVariance());
    part.history.expectTied(part.map, sets);
    std::vector<MapState> maps = splitMap(std::move(part.map), sets);
    if (maps.size() == 1) {
      part.id = next_part_++;
      part.map = std::move(maps.front());
      parts.push_back(std::move(part));
      continue;
    }
    for (MapState& map : maps) {
      parts.emplace_back(next_part_++, params_.loop);
      parts.back().history = part.history;
      parts.back().map = std::move(map);
      parts.back().indexFrom(0);
    }
  }
  parts_ = std::move(parts);
}

void Mapper::finish(int threads) {
  if (!parts_.empty()) passages_.end(active());
  for (MapPart& part : parts_) {
    if (levelTies(maxOpenVariance(), params_, part.map)) settleMap(part.map, 1, params_);
  }
  local_.clear();  // of keyframes that others join now
  splitParts();
  joinParts(parts_, params_, threads);
  if (tieParts(parts_)) splitParts();
  for (MapPart& part : parts_) {
    dropLooseScans(maxOpenVariance(), part.map);
    settleMap(part.map, 1, params_);
    if (splitLandmarks(part.map, params_.primitives.sensor, params_.backend) > 0)
      settleMap(part.map, 1, params_);
    adoptViews(params_.primitives.sensor, part.map);
    unifyPlanes(part.map, params_.primitives.sensor, params_.backend);
    mergeCovered(part.map, params_.planar.cell);
    updateCorners(part.map.landmarks);
  }
  std::stable_sort(parts_.begin(), parts_.end(), [](const MapPart& a, const MapPart& b) {
    return a.map.scans.size() > b.map.scans.size();
  });
  const auto small = [&](const MapPart& part) {
    return part.map.scans.size() < static_cast<std::size_t>(params_.loop.min_scans);
  };
  if (parts_.size() > 1)
    parts_.erase(std::remove_if(parts_.begin() + 1, parts_.end(), small), parts_.end());
}

Trajectory trajectoryOf(const MapState& map) {
  Trajectory result;
  for (const LocalizedScan& scan : map.scans) result.push_back({scan.timestamp, poseOf(map, scan)});
  std::stable_sort(result.begin(), result.end(), [](const StampedPose& a, const StampedPose& b) {
    return a.timestamp < b.timestamp;
  });
  return result;
}

std::map<std::size_t, Eigen::Isometry3d> posesOf(const MapState& map, int session) {
  std::map<std::size_t, Eigen::Isometry3d> result;
  for (const LocalizedScan& scan : map.scans) {
    if (scan.session == session) result.emplace(scan.scan_index, poseOf(map, scan));
  }
  return result;
}

}  // namespace opp::mapping
