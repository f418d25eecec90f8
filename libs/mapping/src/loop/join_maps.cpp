// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/join_maps.h"

#include "opp/mapping/core/se3.h"

#include <iterator>
#include <utility>

namespace opp::mapping {
namespace {

template <typename T>
void moveAll(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  from.clear();
}

template <std::size_t N>
void shift(std::array<int, N>& ids, int offset) {
  for (int& id : ids) id += offset;
}

void shiftLandmarks(int first_keyframe, int first_plane, const Eigen::Isometry3d& map_from_other,
                    LandmarkMap& landmarks) {
  const auto shiftObservations = [&](std::vector<PrimitiveObservation>& observations) {
    for (PrimitiveObservation& o : observations) o.keyframe += first_keyframe;
  };
  for (PlaneLandmark& plane : landmarks.planes) {
    plane.plane_in_map = transformed(map_from_other, plane.plane_in_map);
    shiftObservations(plane.observations);
  }
  for (CornerLandmark& corner : landmarks.corners) {
    shift(corner.planes, first_plane);
    corner.position_in_map = map_from_other * corner.position_in_map;
    shiftObservations(corner.observations);
  }
}

void shiftFactors(int first_keyframe, int first_plane, MapFactors& factors) {
  for (PlaneFactor& f : factors.planes) {
    f.keyframe += first_keyframe;
    f.landmark += first_plane;
  }
  for (RelativePoseFactor& f : factors.relative_poses) {
    f.first += first_keyframe;
    f.second += first_keyframe;
  }
  for (OrthogonalityFactor& f : factors.orthogonalities) shift(f.landmarks, first_plane);
  for (ParallelismFactor& f : factors.parallelisms) shift(f.landmarks, first_plane);
}

void shiftKeyframes(int first_plane, const Eigen::Isometry3d& map_from_other,
                    std::vector<Keyframe>& keyframes) {
  for (Keyframe& keyframe : keyframes) {
    keyframe.map_from_body = normalized(map_from_other * keyframe.map_from_body);
    for (int& landmark : keyframe.landmark_of_plane) {
      if (landmark >= 0) landmark += first_plane;
    }
  }
}

}  // namespace

void appendMap(const Eigen::Isometry3d& map_from_other, MapState&& other, MapState& map) {
  const int first_keyframe = static_cast<int>(map.keyframes.size());
  const int first_plane = static_cast<int>(map.landmarks.planes.size());
  shiftKeyframes(first_plane, map_from_other, other.keyframes);
  shiftLandmarks(first_keyframe, first_plane, map_from_other, other.landmarks);
  shiftFactors(first_keyframe, first_plane, other.factors);
  for (KeyframeLink& link : other.links) {
    link.first += first_keyframe;
    link.second += first_keyframe;
  }
  for (LocalizedScan& scan : other.scans) {
    scan.keyframe += first_keyframe;
    if (scan.open && scan.open->next >= 0) scan.open->next += first_keyframe;
  }
  moveAll(other.keyframes, map.keyframes);
  moveAll(other.landmarks.planes, map.landmarks.planes);
  moveAll(other.landmarks.corners, map.landmarks.corners);
  moveAll(other.factors.planes, map.factors.planes);
  moveAll(other.factors.relative_poses, map.factors.relative_poses);
  moveAll(other.factors.orthogonalities, map.factors.orthogonalities);
  moveAll(other.factors.parallelisms, map.factors.parallelisms);
  moveAll(other.links, map.links);
  moveAll(other.scans, map.scans);
  map.loop_closures += other.loop_closures;
}

}  // namespace opp::mapping
