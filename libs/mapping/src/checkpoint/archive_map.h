// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/run_report.h"
#include "opp/mapping/frontend/lost_scans.h"
#include "opp/mapping/frontend/motion_model.h"
#include "opp/mapping/frontend/open_passage.h"
#include "opp/mapping/loop/claim_pool.h"
#include "opp/mapping/loop/map_part.h"

#include "checkpoint/archive_primitives.h"

#include <cereal/types/map.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/set.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/utility.hpp>

// How cereal stores maps and what is said of them; see archive_primitives.h.

namespace opp::mapping {

template <typename Archive>
void serialize(Archive& archive, ScanFeatures& value) {
  auto& [timestamp, session, scan_index, cloud_in_body, primitives_in_body, rims_in_body] = value;
  archive(timestamp, session, scan_index, cloud_in_body, primitives_in_body, rims_in_body);
}

template <typename Archive>
void serialize(Archive& archive, PlaneCell& value) {
  auto& [row, column] = value;
  archive(row, column);
}

template <typename Archive>
void serialize(Archive& archive, PlaneView& value) {
  auto& [keyframe_plane, is_own, seen, raster_plane, support, timestamps] = value;
  archive(keyframe_plane, is_own, seen, raster_plane, support, timestamps);
}

template <typename Archive>
void serialize(Archive& archive, CornerView& value) {
  auto& [seen, timestamps] = value;
  archive(seen, timestamps);
}

template <typename Archive>
void serialize(Archive& archive, ScanViews& value) {
  auto& [adopted, planes, edges, lines, corners] = value;
  archive(adopted, planes, edges, lines, corners);
}

template <typename Archive>
void serialize(Archive& archive, Keyframe& value) {
  auto& [map_from_body, features, landmark_of_plane, view_centre_in_body, views] = value;
  archive(map_from_body, features, landmark_of_plane, view_centre_in_body, views);
}

template <typename Archive>
void serialize(Archive& archive, PrimitiveObservation& value) {
  auto& [keyframe, primitive] = value;
  archive(keyframe, primitive);
}

template <typename Archive>
void serialize(Archive& archive, PlaneLandmark& value) {
  auto& [plane_in_map, observations] = value;
  archive(plane_in_map, observations);
}

template <typename Archive>
void serialize(Archive& archive, CornerLandmark& value) {
  auto& [planes, position_in_map, observations] = value;
  archive(planes, position_in_map, observations);
}

template <typename Archive>
void serialize(Archive& archive, LandmarkMap& value) {
  auto& [planes, corners] = value;
  archive(planes, corners);
}

template <typename Archive>
void serialize(Archive& archive, PlaneFactor& value) {
  auto& [keyframe, landmark, moments_in_body, effective_samples] = value;
  archive(keyframe, landmark, moments_in_body, effective_samples);
}

template <typename Archive>
void serialize(Archive& archive, RelativePoseFactor& value) {
  auto& [first, second, first_from_second, information, is_loop] = value;
  archive(first, second, first_from_second, information, is_loop);
}

template <typename Archive>
void serialize(Archive& archive, OrthogonalityFactor& value) {
  auto& [landmarks] = value;
  archive(landmarks);
}

template <typename Archive>
void serialize(Archive& archive, ParallelismFactor& value) {
  auto& [landmarks] = value;
  archive(landmarks);
}

template <typename Archive>
void serialize(Archive& archive, MapFactors& value) {
  auto& [planes, relative_poses, orthogonalities, parallelisms] = value;
  archive(planes, relative_poses, orthogonalities, parallelisms);
}

template <typename Archive>
void serialize(Archive& archive, KeyframeLink& value) {
  auto& [first, second, variance] = value;
  archive(first, second, variance);
}

template <typename Archive>
void serialize(Archive& archive, OpenPose& value) {
  auto& [covariance, covariance_between, next, keyframe_from_next, gain] = value;
  archive(covariance, covariance_between, next, keyframe_from_next, gain);
}

template <typename Archive>
void serialize(Archive& archive, LocalizedScan& value) {
  auto& [timestamp, session, scan_index, keyframe, keyframe_from_body, open] = value;
  archive(timestamp, session, scan_index, keyframe, keyframe_from_body, open);
}

template <typename Archive>
void serialize(Archive& archive, MapState& value) {
  auto& [keyframes, landmarks, factors, links, scans, loop_closures] = value;
  archive(keyframes, landmarks, factors, links, scans, loop_closures);
}

template <typename Archive>
void serialize(Archive& archive, ExpectedBeginning& value) {
  auto& [last, first, last_from_first, information] = value;
  archive(last, first, last_from_first, information);
}

template <typename Archive>
void serialize(Archive& archive, PartHistory& value) {
  auto& [origins, beginnings, repeated] = value;
  archive(origins, beginnings, repeated);
}

template <typename Archive>
void serialize(Archive& archive, PosePrior& value) {
  auto& [map_from_body, information] = value;
  archive(map_from_body, information);
}

template <typename Archive>
void serialize(Archive& archive, StampedPose& value) {
  auto& [timestamp, map_from_body] = value;
  archive(timestamp, map_from_body);
}

template <typename Archive>
void serialize(Archive& archive, MotionState& value) {
  auto& [map_from_body, rate, covariance] = value;
  archive(map_from_body, rate, covariance);
}

template <typename Archive>
void serialize(Archive& archive, MotionStep& value) {
  auto& [predicted, shared, found] = value;
  archive(predicted, shared, found);
}

template <typename Archive>
void serialize(Archive& archive, PassedScan& value) {
  auto& [scan, step] = value;
  archive(scan, step);
}

template <typename Archive>
void serialize(Archive& archive, LostScan& value) {
  auto& [scan, predicted] = value;
  archive(scan, predicted);
}

template <typename Archive>
void serialize(Archive& archive, PlaceClaim& value) {
  auto& [keyframe_a, keyframe_b, keyframe_a_from_b, variance, information, map_a_from_map_b,
         place_in_map_b, clarity, claimant, b_looked] = value;
  archive(keyframe_a, keyframe_b, keyframe_a_from_b, variance, information, map_a_from_map_b,
          place_in_map_b, clarity, claimant, b_looked);
}

template <typename Archive>
void serialize(Archive& archive, ScanStamp& value) {
  auto& [scan_index, timestamp] = value;
  archive(scan_index, timestamp);
}

template <typename Archive>
void serialize(Archive& archive, SessionReport& value) {
  auto& [path, bytes, sha256, frames_read, frames_used, frames_apart, frames_lost, keyframes,
         path_length, loop_closures, scans] = value;
  archive(path, bytes, sha256, frames_read, frames_used, frames_apart, frames_lost, keyframes,
          path_length, loop_closures, scans);
}

template <typename Archive>
void serialize(Archive& archive, RunReport& value) {
  auto& [sessions, counts, seconds, warnings] = value;
  archive(sessions, counts, seconds, warnings);
}

}  // namespace opp::mapping
