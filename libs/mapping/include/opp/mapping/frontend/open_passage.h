// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/frontend/motion_model.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace opp::mapping {

/// A scan that leaves its pose open, and the way to it from the scan before, in the frame of the
/// keyframe before.
struct PassedScan {
  std::optional<std::size_t> scan;  ///< in MapState::scans; none: it is not in the map
  MotionStep step;
};

/// Lets `known`, the first scan that fixes its pose again, tell of those before it, all of them
/// since the same keyframe: their poses are smoothed (see OpenPassage). O(scans).
void settlePassed(std::vector<PassedScan> scans, const PassedScan& known, MapState& map);

/// A body came past what leaves its pose open, a bare wall say, by way of some keyframes up to one
/// from where on it sees enough again. What it did before predicts the last keyframe's pose; how
/// fast it came out of the passage tells of the way through it, too: where the velocity before
/// leaves a variance of q·t³/3 after a time t, the velocities at both ends leave q·t³/12 (q:
/// spectral density of the accelerations). What is so learned of the end tells of the scans between
/// (Rauch, Tung, Striebel, AIAA Journal 3(8), 1965, "Maximum likelihood estimates of linear dynamic
/// systems").
///
/// Errors of the ways between its keyframes are not independent: each way begins with the velocity
/// that the one before left. The passage is estimated as a whole, and its ties are made so
/// uncertain that together they are no more certain than that.
class OpenPassage {
 public:
  /// The way from one keyframe to the next.
  struct Leg {
    int keyframe = 0;        ///< at its end, tied to the one before
    double timestamp = 0.0;  ///< of that [s]
    PosePrior tied;          ///< what the tie has from motion so far
    /// Where the first step begins, in the frame of the keyframe before: there, or at the last scan
    /// before the passage.
    MotionState begins;
    std::vector<PassedScan> scans;  ///< the last one is the keyframe's
  };

  void reach(Leg leg);
  /// The last one reached.
  int keyframe() const { return legs_.back().keyframe; }

  /// The next scan of the body that was localized: pose in the last keyframe's body frame at the
  /// end of the passage and its information there, see MatchResult.
  void follow(const StampedPose& later, const Matrix6d& information);

  /// Whether so many scans have followed that more would say little.
  bool isFollowed() const;

  /// What motion says of the last keyframe's body in the frame of the keyframe where the passage
  /// starts: before, and as far as scans have followed, after.
  PosePrior smoothed(const FrontendParams& params) const;

  /// Puts that into the keyframes' ties, in place of what they had from motion, and into the poses
  /// of the scans between. O(scans).
  void tighten(const FrontendParams& params, MapState& map);

 private:
  friend struct StateAccess;  // checkpoints
  struct LaterPose {
    StampedPose pose;
    Matrix6d information;
  };

  std::optional<MotionState> stateAfter(const FrontendParams& params) const;
  std::vector<MotionState> endsOfLegs(const std::optional<MotionState>& after) const;

  std::vector<Leg> legs_;
  std::vector<LaterPose> later_;
};

}  // namespace opp::mapping
