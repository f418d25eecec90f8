// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/se3.h"
#include "opp/mapping/registration/alignment_input.h"
#include "opp/mapping/registration/global_alignment_params.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// What alignment can say about two scans.
enum class AlignmentOutcome : std::uint8_t {
  kAligned,       ///< one pose explains both scans, no other does nearly as well
  kAmbiguous,     ///< several distinct poses explain them about equally well (symmetric room)
  kInsufficient,  ///< what they share does not fix all six degrees of freedom
  kNoOverlap,     ///< no pose explains enough of them
  /// They share three surfaces and nothing more: these fix a pose, but nothing confirms it. Every
  /// bare corner of every room fits every other.
  kUnconfirmed,
};

/// The outcome in words, for people.
std::string_view describe(AlignmentOutcome outcome);

/// A pose that was verified against both scans.
struct AlignmentHypothesis {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  double score = 0.0;     ///< mean over both scans of overlap − 3 × conflicting share, at most 1
  double overlap = 0.0;   ///< share of the samples of the better covered scan that agree, 0–1
  double conflict = 0.0;  ///< conflicts with free space over agreements and conflicts, 0–1
};

/// The same corner of the scene in both scans.
struct CornerMatch {
  int target_corner = 0;
  int source_corner = 0;
};

/// Outcome of an alignment.
struct GlobalAlignment {
  AlignmentOutcome outcome = AlignmentOutcome::kInsufficient;
  /// Set for kAligned only; the identity otherwise: no pose is invented.
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of (ω, v), see `retract`; kAligned only
  int observed_dof = 0;  ///< degrees of freedom that the shared surfaces fix, 0–6
  double overlap = 0.0;  ///< of the best hypothesis
  double rms = 0.0;      ///< distance of agreeing samples at the best hypothesis [m]
  /// How clearly the samples prefer the best pose to every other that was tried: votes for it minus
  /// votes for the other, over the geometric mean of all samples and of those that tell them apart.
  /// Below 0.2 (0.1 if the other has far less that confirms it) several poses explain the scans.
  double clarity = 1.0;
  /// Share of the agreeing samples that lie on none of the three surfaces that fix the pose.
  double confirmation = 0.0;
  std::vector<CornerMatch> corner_matches;      ///< at the best hypothesis
  std::vector<AlignmentHypothesis> hypotheses;  ///< distinct, best first; for callers who know more
};

/// Registers two scans (or keyframes, or merged maps) in any relative pose, without initial guess.
///
/// Rotations come from pairs of plane directions, whose normals know the side they were seen from,
/// so that a corner's 24 frames reduce to 3 and those of a whole Manhattan-like scan to 24 shared
/// ones. Translations come from corners and from offsets of parallel planes; along a direction that
/// no shared plane fixes they are tried one by one. The best are refined (point to plane, plane
/// moments) and verified both ways: samples of one scan must lie on surfaces of the other, and
/// must not stand where the other looked through (seen from its viewpoints). Deterministic.
/// \param target,source clouds with primitives, each in its own frame
/// \param sensor noise of both scans
/// \return kInsufficient for clouds that are empty or whose planes are all parallel.
/// \throws std::invalid_argument if a parameter is out of range, if labels and cloud of a scan
/// differ in length, or if a cloud has samples but no spacing.
GlobalAlignment alignGlobally(const AlignmentInput& target, const AlignmentInput& source,
                              const SensorModel& sensor, const GlobalAlignmentParams& params);

/// Refines and verifies a pose that the caller believes to be right to about a search cell. No
/// other pose is tried, so the answer is never kAmbiguous, and the caller's belief stands for what
/// would confirm it, so it is never kUnconfirmed. Errors as above.
GlobalAlignment alignNear(const AlignmentInput& target, const AlignmentInput& source,
                          const Eigen::Isometry3d& target_from_source, const SensorModel& sensor,
                          const GlobalAlignmentParams& params);

/// The same for a pose that is to stay as it is.
GlobalAlignment judgePose(const AlignmentInput& target, const AlignmentInput& source,
                          const Eigen::Isometry3d& target_from_source, const SensorModel& sensor,
                          const GlobalAlignmentParams& params);

}  // namespace opp::mapping
