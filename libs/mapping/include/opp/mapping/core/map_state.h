// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/keyframe.h"
#include "opp/mapping/core/landmark_map.h"
#include "opp/mapping/core/map_factors.h"
#include "opp/mapping/core/se3.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace opp::mapping {

/// What is known of a pose that the scan itself leaves open: motion carries it from the keyframe
/// before to the one after.
struct OpenPose {
  /// Of (ω, v) relative to the keyframe before alone, in its axes, see `retract` [rad², m²].
  Matrix6d covariance = Matrix6d::Zero();
  Matrix6d covariance_between = Matrix6d::Zero();  ///< the same if the one after is known, too
  int next = -1;  ///< the keyframe after; −1: there is none, or nothing ties it
  Eigen::Isometry3d keyframe_from_next = Eigen::Isometry3d::Identity();  ///< as it was expected
  /// So the pose moves with the next keyframe, (ω, v) in the axes of the one before.
  Matrix6d gain = Matrix6d::Zero();
};

/// A scan that was localized; its pose follows the keyframe that was the newest when it came, and
/// the next one as far as it leaves its pose open.
struct LocalizedScan {
  double timestamp = 0.0;  ///< Unix time [s]
  int session = 0;
  std::size_t scan_index = 0;  ///< see ScanFeatures
  int keyframe = 0;
  Eigen::Isometry3d keyframe_from_body = Eigen::Isometry3d::Identity();
  std::optional<OpenPose> open = std::nullopt;

  ScanId id() const { return {session, scan_index}; }
};

/// Two keyframes whose relative pose was measured, and how well: what tells whether a place that
/// comes into view again is where the map has it.
struct KeyframeLink {
  int first = 0;
  int second = 0;
  double variance = 0.0;  ///< of the relative position, worst direction [m²]
};

/// The map as it grows: keyframes, landmarks, and the measurements that tie them together. Its
/// frame is that of its first keyframe.
struct MapState {
  std::vector<Keyframe> keyframes;
  LandmarkMap landmarks;
  MapFactors factors;
  std::vector<KeyframeLink> links;
  std::vector<LocalizedScan> scans;  ///< all localized scans, keyframes included
  std::size_t loop_closures = 0;     ///< places recognized, joins of maps included
};

/// Pose of the body at a scan of `map`: map_from_body.
Eigen::Isometry3d poseOf(const MapState& map, const LocalizedScan& scan);

}  // namespace opp::mapping
