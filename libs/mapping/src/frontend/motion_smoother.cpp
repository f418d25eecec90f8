// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frontend/motion_smoother.h"

#include "registration/observability.h"

#include <Eigen/Cholesky>

#include <cmath>

namespace opp::mapping {
namespace {

using Index = std::size_t;
using Covariance = MotionState::Covariance;
using StateVector = Eigen::Matrix<double, 12, 1>;

MotionState changedBy(const StateVector& change, const MotionState& state) {
  return {retract(state.map_from_body, change.head<6>()), state.rate + change.tail<6>(),
          state.covariance};
}

/// What linearization in `givenRate` leaves out, R·v ≈ v + ω × v, at one standard deviation of ω:
/// at most (Σσ²/2)·|v|, added as a variance (second-order filter: Jazwinski 1970, "Stochastic
/// Processes and Filtering Theory", 9.3).
double variationOfTurned(const Eigen::Vector3d& v, const Eigen::Matrix3d& covariance_of_turn) {
  return std::pow(0.5 * covariance_of_turn.trace() * v.norm(), 2);
}

/// The rate in the axes of a body that is turned by the errors of its pose, by those.
Eigen::Matrix<double, 6, 12> turnsOfRate(const Vector6d& rate) {
  Eigen::Matrix<double, 6, 12> by_state = Eigen::Matrix<double, 6, 12>::Zero();
  by_state.topLeftCorner<3, 3>() = crossMatrix(rate.head<3>());
  by_state.block<3, 3>(3, 0) = crossMatrix(rate.tail<3>());
  by_state.rightCols<6>().setIdentity();
  return by_state;
}

MotionWay inFrame(const Eigen::Isometry3d& frame_from_map, const MotionWay& way) {
  const MotionStep turned = inFrame(frame_from_map, MotionStep{way.end, way.shared, way.begin});
  return {turned.found, turned.predicted, turned.shared};
}

/// A state that also knows of its rate, in its own axes, what the scans told that made `now` of
/// `before`.
MotionState learned(const MotionState& state, const MotionState& before, const MotionState& now) {
  const Eigen::Matrix<double, 6, 12> by_state = turnsOfRate(state.rate);
  const Eigen::Matrix<double, 12, 6> shared = state.covariance * by_state.transpose();
  const Matrix6d covariance = by_state * shared, own = inverse(covariance);
  const Matrix6d before_information = inverse(before.rateCovariance()),
                 now_information = inverse(now.rateCovariance());
  const Matrix6d after = inverse(own + now_information - before_information);
  const Vector6d pull =
      now_information * (now.rate - state.rate) - before_information * (before.rate - state.rate);
  const Eigen::Matrix<double, 12, 6> gain = shared * own;
  MotionState result = changedBy(gain * (after * pull), state);
  result.covariance += gain * (after - covariance) * gain.transpose();
  return result;
}

}  // namespace

MotionState givenRate(const MotionState& state, const MotionState& measured) {
  const Eigen::Matrix<double, 6, 12> by_state = turnsOfRate(measured.rate);
  const Eigen::Matrix<double, 12, 6> shared = state.covariance * by_state.transpose();
  Matrix6d innovation = by_state * shared + measured.rateCovariance();
  for (const int kind : {0, 3})
    innovation.diagonal().segment<3>(kind).array() +=
        variationOfTurned(measured.rate.segment<3>(kind), state.covariance.topLeftCorner<3, 3>());
  const Eigen::Matrix<double, 12, 6> gain = innovation.ldlt().solve(shared.transpose()).transpose();
  MotionState result = changedBy(gain * (measured.rate - state.rate), state);
  result.covariance -= gain * shared.transpose();
  return result;
}

std::vector<SmoothedState> smoothedStates(const std::vector<const MotionStep*>& steps,
                                          const MotionState& last) {
  std::vector<SmoothedState> result(steps.size());
  result.back().state = last;
  for (Index k = steps.size() - 1; k > 0; --k) {
    const MotionStep& step = *steps[k];
    const MotionState &before = steps[k - 1]->found, &after = result[k].state;
    const Covariance gain =
        step.predicted.covariance.ldlt().solve(step.shared.transpose()).transpose();
    StateVector change;
    change << difference(step.predicted.map_from_body, after.map_from_body),
        after.rate - step.predicted.rate;
    result[k - 1].state = changedBy(gain * change, before);
    result[k - 1].state.covariance +=
        gain * (after.covariance - step.predicted.covariance) * gain.transpose();
    result[k - 1].by_last = gain * result[k].by_last;
  }
  return result;
}

MotionWay wayOf(const MotionState& begins, std::vector<const MotionStep*> steps,
                const MotionState& end) {
  MotionStep begin;
  begin.found = begins;
  steps.insert(steps.begin(), &begin);
  const SmoothedState smoothed = smoothedStates(steps, end).front();
  return {smoothed.state, end, smoothed.by_last * end.covariance};
}

MotionStep continued(const MotionState& begins, const MotionWay& in_first, MotionState& begin) {
  const Eigen::Isometry3d start_from_first = begin.map_from_body;
  const MotionWay way = inFrame(start_from_first, in_first);
  begin = learned(begin, inFrame(start_from_first, begins), way.begin);
  const Eigen::Matrix<double, 12, 6> by_rate =
      way.shared.bottomRows<6>().transpose() * inverse(way.begin.rateCovariance());
  Covariance by_begin = by_rate * turnsOfRate(begin.rate);
  by_begin.topLeftCorner<6, 6>() +=
      movedBy(way.end.map_from_body.translation() - start_from_first.translation());
  by_begin.block<3, 3>(6, 0) -= crossMatrix(way.end.rate.head<3>());
  by_begin.block<3, 3>(9, 0) -= crossMatrix(way.end.rate.tail<3>());
  const Vector6d rate_off = begin.rate - way.begin.rate;
  const Eigen::Isometry3d moved = begin.map_from_body * start_from_first.inverse();
  MotionStep step;
  step.predicted = changedBy(by_rate * rate_off, inFrame(moved, way.end));
  step.shared = begin.covariance * by_begin.transpose();
  step.predicted.covariance = by_begin * step.shared + way.end.covariance -
                              by_rate * way.begin.rateCovariance() * by_rate.transpose();
  step.found = step.predicted;
  return step;
}

}  // namespace opp::mapping
