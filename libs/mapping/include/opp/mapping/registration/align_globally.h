// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/core/se3.h"
#include "opp/mapping/registration/global_alignment_params.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// What `alignGlobally` can say about two scans.
enum class AlignmentOutcome : std::uint8_t {
  kAligned,       ///< one pose explains both scans, no other does nearly as well
  kAmbiguous,     ///< several distinct poses explain them about equally well (symmetric room)
  kInsufficient,  ///< what they share does not fix all six degrees of freedom
  kNoOverlap,     ///< no pose explains enough of them
};

/// The outcome in words, for people.
std::string_view describe(AlignmentOutcome outcome);

/// A pose that was verified against both scans.
struct AlignmentHypothesis {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  double score = 0.0;     ///< mean over both scans of overlap − conflict, at most 1
  double overlap = 0.0;   ///< share of the samples of the better covered scan that agree, 0–1
  double conflict = 0.0;  ///< conflicts with free space over agreements and conflicts, 0–1
};

/// The same corner of the scene in both scans.
struct CornerMatch {
  int target_corner = 0;
  int source_corner = 0;
};

/// Outcome of `alignGlobally`.
struct GlobalAlignment {
  AlignmentOutcome outcome = AlignmentOutcome::kInsufficient;
  /// Set for kAligned only; the identity otherwise: no pose is invented.
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of (ω, v), see `retract`; kAligned only
  int observed_dof = 0;  ///< degrees of freedom that the shared surfaces fix, 0–6
  double overlap = 0.0;  ///< of the best hypothesis
  double rms = 0.0;      ///< distance of agreeing samples at the best hypothesis [m]
  /// How clearly the samples prefer the best pose to every other that was tried: votes for it minus
  /// votes for the other, over the geometric mean of all samples and of those that tell the two
  /// apart. Below 0.2 several poses explain the scans.
  double clarity = 1.0;
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
/// must not stand where the other looked through (seen from its viewpoint). Deterministic.
/// \param target,source clouds with primitives, each in its own frame; normals toward the viewpoint
/// \return kInsufficient for clouds that are empty or whose planes are all parallel.
/// \throws std::invalid_argument if a parameter is out of range if labels and cloud of a scan
/// differ in length, or if a cloud has samples but no spacing.
GlobalAlignment alignGlobally(const ScanFeatures& target, const ScanFeatures& source,
                              const GlobalAlignmentParams& params);

}  // namespace opp::mapping
