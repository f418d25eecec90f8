// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/frontend/motion_model.h"

#include <vector>

namespace opp::mapping {

/// A body came past what leaves its pose open, a bare wall say, up to a keyframe from where on it
/// sees enough again. What it did before predicts the keyframe's pose; how fast it came out of the
/// passage tells of the way through it, too: where the velocity before leaves a variance of q·t³/3
/// after a time t, the velocities at both ends leave q·t³/12 (q: spectral density of the
/// accelerations).
class OpenPassage {
 public:
  /// \param keyframe the one at the end of the passage, tied to the one before
  /// \param first_from_body what motion predicted at it, in the frame of the keyframe before
  /// \param tied what the tie has from motion so far, in the same frame
  OpenPassage(int keyframe, double timestamp, MotionState first_from_body, PosePrior tied);

  int keyframe() const { return keyframe_; }

  /// The next scan of the body that was localized: pose in the keyframe's body frame at the end of
  /// the passage and its information there, see MatchResult.
  void follow(const StampedPose& later, const Matrix6d& information);

  /// Whether so many scans have followed that more would say little.
  bool isFollowed() const;

  /// What motion says of the keyframe's body in the frame of the keyframe before: before, and as
  /// far as scans have followed, after.
  PosePrior smoothed(const FrontendParams& params) const;

  /// Puts that into the keyframe's tie, in place of what it had from motion.
  void tighten(const FrontendParams& params, MapState& map);

 private:
  friend struct StateAccess;  // checkpoints
  struct LaterPose {
    StampedPose pose;
    Matrix6d information;
  };

  int keyframe_;
  double timestamp_;
  MotionState first_from_body_;
  PosePrior tied_;
  std::vector<LaterPose> later_;
};

}  // namespace opp::mapping
