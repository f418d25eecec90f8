// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/frontend/motion_model.h"

#include <vector>

namespace opp::mapping {

/// A state with all that is known of the last one.
struct SmoothedState {
  MotionState state;
  /// How it moves with the last one.
  MotionState::Covariance by_last = MotionState::Covariance::Identity();
};

/// The states after steps of a filter (`MotionStep::found`), given that of the last one (Rauch,
/// Tung, Striebel, AIAA Journal 3(8), 1965, "Maximum likelihood estimates of linear dynamic
/// systems"). O(steps)
std::vector<SmoothedState> smoothedStates(const std::vector<const MotionStep*>& steps,
                                          const MotionState& last);

/// A state that has also the rate of `measured`, in whose axes it was placed where the state
/// predicts its pose: turning the one turns the other. A step of a Kalman filter.
MotionState givenRate(const MotionState& state, const MotionState& measured);

/// What is known of a way, in the frame of the keyframe where it begins.
struct MotionWay {
  MotionState begin;  ///< with what the scans on the way tell of it
  MotionState end;
  MotionState::Covariance shared;  ///< of begin (rows) and end (columns)
};

/// The way from `begins` by some steps to `end`, which is the state before or after the last one.
/// O(steps)
MotionWay wayOf(const MotionState& begins, std::vector<const MotionStep*> steps,
                const MotionState& end);

/// The step that a way makes whose first keyframe is known in another frame: its pose and how it
/// moves there are `begin`, which gets what the scans on the way tell of its rate. \param begins
/// the way's begin before its scans
MotionStep continued(const MotionState& begins, const MotionWay& way, MotionState& begin);

}  // namespace opp::mapping
