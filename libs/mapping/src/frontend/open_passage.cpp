// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/open_passage.h"

#include "registration/observability.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace opp::mapping {
namespace {

/// Scans after which a velocity is known about as well as accelerations allow.
constexpr std::size_t kEnoughScans = 4;

/// So certain is a frame of itself [1/rad², 1/m²].
constexpr double kExact = 1e12;

/// What linearization in `givenRate` leaves out, R·v ≈ v + ω × v, at one standard deviation of ω:
/// at most (Σσ²/2)·|v|, added as a variance (second-order filter: Jazwinski 1970, "Stochastic
/// Processes and Filtering Theory", 9.3).
double variationOfTurned(const Eigen::Vector3d& v, const Eigen::Matrix3d& covariance_of_turn) {
  return std::pow(0.5 * covariance_of_turn.trace() * v.norm(), 2);
}

/// A state that has also the rate of `measured`, in whose axes it was placed where the state
/// predicts its pose: turning the one turns the other. A step of a Kalman filter.
MotionState givenRate(const MotionState& state, const MotionState& measured) {
  Eigen::Matrix<double, 6, 12> by_state = Eigen::Matrix<double, 6, 12>::Zero();
  by_state.topLeftCorner<3, 3>() = crossMatrix(measured.rate.head<3>());
  by_state.block<3, 3>(3, 0) = crossMatrix(measured.rate.tail<3>());
  by_state.rightCols<6>().setIdentity();
  const Eigen::Matrix<double, 12, 6> shared = state.covariance * by_state.transpose();
  Matrix6d innovation = by_state * shared + measured.covariance.bottomRightCorner<6, 6>();
  for (const int kind : {0, 3})
    innovation.diagonal().segment<3>(kind).array() +=
        variationOfTurned(measured.rate.segment<3>(kind), state.covariance.topLeftCorner<3, 3>());
  const Eigen::Matrix<double, 12, 6> gain = innovation.ldlt().solve(shared.transpose()).transpose();
  const Eigen::Matrix<double, 12, 1> change = gain * (measured.rate - state.rate);
  MotionState result;
  result.map_from_body = retract(state.map_from_body, change.head<6>());
  result.rate = state.rate + change.tail<6>();
  result.covariance = state.covariance - gain * shared.transpose();
  return result;
}

}  // namespace

OpenPassage::OpenPassage(int keyframe, double timestamp, MotionState first_from_body,
                         PosePrior tied)
    : keyframe_(keyframe),
      timestamp_(timestamp),
      first_from_body_(std::move(first_from_body)),
      tied_(std::move(tied)) {}

void OpenPassage::follow(const StampedPose& later, const Matrix6d& information) {
  later_.push_back({later, information});
}

bool OpenPassage::isFollowed() const { return later_.size() >= kEnoughScans; }

PosePrior OpenPassage::smoothed(const FrontendParams& params) const {
  MotionState both = first_from_body_;
  if (!later_.empty()) {
    // Time runs backwards from the last scan to the keyframe.
    MotionModel back(params);
    for (auto scan = later_.rbegin(); scan != later_.rend(); ++scan)
      back.update({-scan->pose.timestamp, scan->pose.map_from_body}, std::nullopt,
                  scan->information);
    back.update({-timestamp_, Eigen::Isometry3d::Identity()}, std::nullopt,
                kExact * Matrix6d::Identity());
    MotionState out = inFrame(first_from_body_.map_from_body, back.state());
    out.rate = (-out.rate).eval();
    both = givenRate(first_from_body_, out);
  }
  return {both.map_from_body, inverse(both.covariance.topLeftCorner<6, 6>())};
}

void OpenPassage::tighten(const FrontendParams& params, MapState& map) {
  const auto tie = std::find_if(
      map.factors.relative_poses.begin(), map.factors.relative_poses.end(),
      [&](const RelativePoseFactor& f) { return f.second == keyframe_ && !f.is_loop; });
  if (tie == map.factors.relative_poses.end()) return;
  const PosePrior motion = smoothed(params);
  const auto pull = [&](const PosePrior& prior) -> Vector6d {
    return prior.information * difference(tie->first_from_second, prior.map_from_body);
  };
  const Vector6d change = pull(motion) - pull(tied_);
  tie->information += motion.information - tied_.information;
  tie->first_from_second = retract(tie->first_from_second, tie->information.ldlt().solve(change));
  tied_ = motion;
}

}  // namespace opp::mapping
