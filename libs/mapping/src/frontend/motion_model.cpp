// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/motion_model.h"

#include "registration/observability.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

Vector6d perKind(double of_rotation, double of_translation) {
  Vector6d vector;
  vector << Eigen::Vector3d::Constant(of_rotation), Eigen::Vector3d::Constant(of_translation);
  return vector;
}

MotionState::Covariance turnsOfState(const Eigen::Isometry3d& to_from) {
  MotionState::Covariance turns = MotionState::Covariance::Zero();
  turns.topLeftCorner<6, 6>() = turns.bottomRightCorner<6, 6>() = turned(to_from.linear());
  return turns;
}

/// Stamps that are equal or run backwards must not give infinite velocities.
constexpr double kMinTimeStep = 1e-3;
/// A scan tells how far a prediction was off if its own variance is below this share of that.
constexpr double kTelling = 0.25;
/// For so long an acceleration stays about the same [s].
constexpr double kAccelerationTime = 0.1;

}  // namespace

bool isKnown(const Matrix6d& covariance, const FrontendParams& params) {
  return largestVariance(covariance.topLeftCorner<3, 3>()) <=
             params.max_drift_rotation * params.max_drift_rotation &&
         largestVariance(covariance.bottomRightCorner<3, 3>()) <=
             params.max_drift_translation * params.max_drift_translation;
}

Vector6d typicalMotion(double seconds, const FrontendParams& params) {
  return (perKind(params.angular_speed, params.speed) * std::max(seconds, kMinTimeStep))
      .cwiseAbs2();
}

PosePrior MotionState::pose() const { return {map_from_body, inverse(poseCovariance())}; }

MotionState inFrame(const Eigen::Isometry3d& frame_from_map, const MotionState& state) {
  const MotionState::Covariance turns = turnsOfState(frame_from_map);
  return {frame_from_map * state.map_from_body, turned(frame_from_map.linear()) * state.rate,
          turns * state.covariance * turns.transpose()};
}

MotionStep inFrame(const Eigen::Isometry3d& frame_from_map, const MotionStep& step) {
  const MotionState::Covariance turns = turnsOfState(frame_from_map);
  return {inFrame(frame_from_map, step.predicted), turns * step.shared * turns.transpose(),
          inFrame(frame_from_map, step.found)};
}

void MotionModel::start(const StampedPose& pose,
                        const std::optional<Eigen::Isometry3d>& odom_from_body) {
  started_ = true;
  timestamp_ = pose.timestamp;
  last_ = MotionState{};
  last_.map_from_body = pose.map_from_body;
  last_.covariance.diagonal().tail<6>() = perKind(params_.angular_speed, params_.speed).cwiseAbs2();
  last_odom_from_body_ = odom_from_body;
  setAnchor();
}

MotionStep MotionModel::update(const StampedPose& pose,
                               const std::optional<Eigen::Isometry3d>& odom_from_body,
                               const Matrix6d& information) {
  if (!started_) {
    start(pose, odom_from_body);
    return {};
  }
  MotionStep step = predictStep(pose.timestamp, odom_from_body);
  MotionState state = step.predicted;
  if (!odom_from_body) learn(state, pose.map_from_body, information);
  const Matrix6d before = state.poseCovariance();
  const Matrix6d before_inverse = inverse(before);
  const Matrix6d after = inverse(before_inverse + information);
  // The rate moves with the pose as far as the two go together.
  const Matrix6d gain = state.covariance.bottomLeftCorner<6, 6>() * before_inverse;
  state.rate += gain * difference(state.map_from_body, pose.map_from_body);
  state.covariance.bottomRightCorner<6, 6>() -= gain * (before - after) * gain.transpose();
  state.covariance.topLeftCorner<6, 6>() = after;
  state.covariance.bottomLeftCorner<6, 6>() = gain * after;
  state.covariance.topRightCorner<6, 6>() = after * gain.transpose();
  state.covariance = 0.5 * (state.covariance + state.covariance.transpose()).eval();
  state.map_from_body = pose.map_from_body;
  last_ = step.found = state;
  timestamp_ = pose.timestamp;
  last_odom_from_body_ = odom_from_body;
  return step;
}

void MotionModel::correct(const Eigen::Isometry3d& last_pose) {
  if (!started_) return;
  last_ = inFrame(last_pose * last_.map_from_body.inverse(), last_);
  last_.map_from_body = last_pose;  // without rounding
}

PosePrior MotionModel::predict(double timestamp,
                               const std::optional<Eigen::Isometry3d>& odom_from_body) const {
  if (!started_) return {};
  return predictState(timestamp, odom_from_body).pose();
}

MotionState MotionModel::predictState(
    double timestamp, const std::optional<Eigen::Isometry3d>& odom_from_body) const {
  return predictStep(timestamp, odom_from_body).predicted;
}

MotionStep MotionModel::predictStep(double timestamp,
                                    const std::optional<Eigen::Isometry3d>& odom_from_body) const {
  const double step = std::max(timestamp - timestamp_, kMinTimeStep);
  if (odom_from_body && last_odom_from_body_)
    return carriedByOdometry(step, last_odom_from_body_->inverse() * *odom_from_body);
  return carriedByVelocity(step);
}

MotionStep MotionModel::carriedByOdometry(double step,
                                          const Eigen::Isometry3d& last_from_now) const {
  MotionStep result;
  MotionState& state = result.predicted;
  state.map_from_body = normalized(last_.map_from_body * last_from_now);
  state.rate = difference(last_.map_from_body, state.map_from_body) / step;
  const Vector6d variance = odometryVariance(last_from_now);
  state.covariance.topLeftCorner<6, 6>() = last_.covariance.topLeftCorner<6, 6>();
  state.covariance.diagonal().head<6>() += variance;
  // Should the odometry end, its last speed is the best guess.
  state.covariance.diagonal().tail<6>() = variance / (step * step) + agility() * step;
  result.shared.leftCols<6>() = last_.covariance.leftCols<6>();
  return result;
}

MotionStep MotionModel::carriedByVelocity(double step) const {
  MotionStep result;
  MotionState& state = result.predicted;
  state.map_from_body = retract(last_.map_from_body, step * last_.rate);
  state.rate = last_.rate;
  MotionState::Covariance carry = MotionState::Covariance::Identity();
  carry.topRightCorner<6, 6>() = step * Matrix6d::Identity();
  result.shared = last_.covariance * carry.transpose();
  state.covariance = carry * result.shared;
  const Vector6d density = agility();
  state.covariance.topLeftCorner<6, 6>().diagonal() += density * step * step * step / 3.0;
  state.covariance.topRightCorner<6, 6>().diagonal() += density * step * step / 2.0;
  state.covariance.bottomLeftCorner<6, 6>().diagonal() += density * step * step / 2.0;
  state.covariance.bottomRightCorner<6, 6>().diagonal() += density * step;
  return result;
}

Vector6d MotionModel::odometryVariance(const Eigen::Isometry3d& first_from_second) const {
  const double ratio = params_.odometry_noise_ratio;
  return perKind(
             std::hypot(params_.odometry_noise_rotation, ratio * rotationAngle(first_from_second)),
             std::hypot(params_.odometry_noise_translation,
                        ratio * first_from_second.translation().norm()))
      .cwiseAbs2();
}

Vector6d MotionModel::agility() const {
  const Eigen::Vector2d share = unrest();
  return kAccelerationTime *
         perKind(share[0] * params_.angular_acceleration, share[1] * params_.acceleration)
             .cwiseAbs2();
}

Eigen::Vector2d MotionModel::unrest() const {
  return (params_.unrest_caution * squared_unrest_.cwiseSqrt())
      .cwiseMax(params_.least_unrest)
      .cwiseMin(1.0);
}

void MotionModel::learn(const MotionState& predicted, const Eigen::Isometry3d& found,
                        const Matrix6d& information) {
  const Matrix6d expected = predicted.poseCovariance();
  const Matrix6d measured = covarianceOf(information);
  const Vector6d error = difference(predicted.map_from_body, found);
  const Eigen::Vector2d share = unrest();
  const double weight = 1.0 / params_.unrest_memory;
  for (const int kind : {0, 1}) {
    const Eigen::Matrix3d of_prediction = expected.block<3, 3>(3 * kind, 3 * kind);
    const Eigen::Matrix3d of_scan = measured.block<3, 3>(3 * kind, 3 * kind);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(of_prediction,
                                                              Eigen::EigenvaluesOnly);
    if (largestVariance(of_scan) > kTelling * axes.eigenvalues()[0]) continue;
    const Eigen::Vector3d off = error.segment<3>(3 * kind);
    const double squared_sigmas = off.dot((of_prediction + of_scan).ldlt().solve(off)) / 3.0;
    const double seen = share[kind] * share[kind] * squared_sigmas;
    squared_unrest_[kind] += weight * (std::min(1.0, seen) - squared_unrest_[kind]);
  }
}

PosePrior MotionModel::lastPose(double timestamp) const {
  if (!started_) return {};
  PosePrior prior;
  prior.map_from_body = last_.map_from_body;
  // What was open at the last pose is no better known now.
  Matrix6d covariance = last_.poseCovariance();
  covariance.diagonal() += typicalMotion(timestamp - timestamp_, params_);
  prior.information = inverse(covariance);
  return prior;
}

Matrix6d MotionModel::informationSinceAnchor(
    double timestamp, const std::optional<Eigen::Isometry3d>& odom_from_body) const {
  const double time = std::max(timestamp - anchor_.timestamp, kMinTimeStep);
  if (odom_from_body && anchor_.odom_from_body) {
    const Vector6d variance = odometryVariance(anchor_.odom_from_body->inverse() * *odom_from_body);
    return variance.cwiseInverse().asDiagonal();
  }
  Matrix6d covariance = time * time * anchor_.rate_covariance;
  covariance.diagonal() += agility() * time * time * time / 3.0;
  return inverse(covariance);
}

void MotionModel::beginAtLastPose() {
  last_.covariance.topRows<6>().setZero();
  last_.covariance.leftCols<6>().setZero();
}

void MotionModel::setAnchor() {
  anchor_ = {timestamp_, last_odom_from_body_, last_.rateCovariance()};
}

}  // namespace opp::mapping
