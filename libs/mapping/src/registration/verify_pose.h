// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "registration/scan_model.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace opp::mapping {

/// How the samples of one scan fare in another one.
struct Agreement {
  int samples = 0;
  int agreeing = 0;               ///< lie on a surface that faces the same way
  int conflicting = 0;            ///< stand where the other scan looked through
  double squared_distance = 0.0;  ///< of the agreeing ones to their surfaces [m²]

  double overlap() const { return samples == 0 ? 0.0 : double(agreeing) / samples; }
};

/// The agreement of both scans with each other.
struct Verification {
  Agreement of_source, of_target;
  /// What each verification sample says (source's first): 1 agrees, −3 stands in free space, which
  /// is rarer at a right pose than agreement at a wrong one, 0 cannot tell.
  std::vector<std::int8_t> votes;
  /// The other scan's sample that each agrees with; −1: none.
  std::vector<std::int32_t> partners;

  double score() const;     ///< mean of the votes over both scans
  double overlap() const;   ///< of the scan that is covered better
  double conflict() const;  ///< conflicting over agreeing and conflicting, both scans; 0 if none
  double rms() const;       ///< of agreeing samples [m]
};

/// How clearly the samples speak for pose a against pose b, −1 to 1: their advantage (votes for a
/// minus votes for b) over the geometric mean of all samples and of those that tell the two apart.
/// So neither a small difference in two otherwise equal views (furniture in a symmetric room) is
/// lost, nor does noise decide.
double clarity(const Verification& a, const Verification& b);

/// Number of the source's screening samples that have a target sample of like normal in reach: a
/// first, cheap look at a pose. Gives up, with 0, once `at_least` is out of reach.
int screenPose(const ScanModel& target, const ScanModel& source,
               const Eigen::Isometry3f& target_from_source, float min_cosine, int at_least);

/// Checks all verification samples of both scans. \param slack how far off the pose may still be
/// [m]
Verification verifyPose(const ScanModel& target, const ScanModel& source,
                        const Eigen::Isometry3d& target_from_source, double slack,
                        const GlobalAlignmentParams& params);

}  // namespace opp::mapping
