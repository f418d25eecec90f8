// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace opp {

/// Weakest information that the normal equations are given: an unobserved direction then has a
/// variance of 1 rad², which is as good as unknown for a direction [1/rad²].
inline constexpr double kPriorInformation = 1.0;
/// A step of this size changes no digit that float32 points could give [rad].
inline constexpr double kStepTolerance = 1e-12;
/// Error of E from rounding, relative to the sum of its terms' sizes, with a margin.
inline constexpr double kEnergyRounding = 1e-14;
inline constexpr int kMaxSteps = 50;

/// Levenberg's and Marquardt's choice of steps.
class StepDamping {
 public:
  /// Starts at the energy `current`, which is known up to `rounding`.
  StepDamping(double current, double rounding) : current_(current), rounding_(rounding) {}

  double value() const { return value_; }
  /// Whether to take the step to the energy `next`; sets the damping of the step after.
  bool accepts(double next) {
    // Near the minimum E is flat to its last digits, while the step still gains some.
    const bool accepted = next <= current_ + rounding_;
    if (accepted) current_ = next;
    value_ = accepted ? 0.1 * value_ : 10.0 * value_ + 1e-4;
    return accepted;
  }

 private:
  double current_, rounding_;
  double value_ = 0.0;
};

/// What `solveNormals` does with a normal that nothing couples to others, in matrices of fixed
/// size: most planes amid clutter are such. True if it converged.
bool solveAlone(const Eigen::Matrix3d& scatter, Eigen::Vector3d& normal);

}  // namespace opp
