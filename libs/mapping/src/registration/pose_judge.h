// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/registration/align_globally.h"

#include "registration/refine_pose.h"
#include "registration/scan_model.h"
#include "registration/verify_pose.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// A pose with all that is known about it.
struct Candidate {
  RefinedPose pose;
  Verification verification;
  double score = 0.0;
};

/// What speaks for a pose beyond that which fixes it. A corner of a room has nothing.
struct Confirmation {
  int agreeing = 0;    ///< samples, counted from both sides
  int confirming = 0;  ///< of these: on none of the three surfaces (fewer where there are fewer)
                       ///< with independent normals that have most of them

  double share() const;
};

Confirmation confirmationOf(const ScanModel& target, const ScanModel& source,
                            const Candidate& candidate);

/// Answers whether a pose may be claimed.
class PoseJudge {
 public:
  PoseJudge(const ScanModel& target, const ScanModel& source, const GlobalAlignmentParams& params);

  /// How far off a refined pose may still be, when it is verified [m].
  double refinedSlack() const { return refined_slack_; }
  /// Length of a step that makes another pose [m].
  double distinctStep() const { return distinct_step_; }

  /// The answer for the best of some distinct candidates, best first, at least one.
  GlobalAlignment judge(const std::vector<Candidate>& candidates) const;

 private:
  AlignmentOutcome outcome(const std::vector<Candidate>& candidates,
                           const Confirmation& confirmation, const GlobalAlignment& answer) const;
  /// \param confirmation of the best
  bool rivals(const Candidate& best, const Confirmation& confirmation,
              const Candidate& other) const;
  int observedDof(const Candidate& best) const;
  bool slides(const Candidate& best, const Vector6d& step) const;
  Vector6d units() const;
  std::vector<CornerMatch> cornerMatches(const Eigen::Isometry3d& target_from_source) const;
  double cornerDistance(int t, int s, const Eigen::Isometry3d& target_from_source) const;

  const ScanModel& target_;
  const ScanModel& source_;
  const GlobalAlignmentParams& params_;
  double refined_slack_, distinct_step_;
};

}  // namespace opp::mapping
