// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/trajectory.h"
#include "opp/mapping/frontend/frontend_params.h"
#include "opp/mapping/registration/match_scan.h"

#include <optional>

namespace opp::mapping {

/// How far a body gets from a pose at its typical speeds in `seconds`: variances of (ω, v), see
/// `retract` [rad², m²]. Positive also for stamps that are equal or run backwards.
Vector6d typicalMotion(double seconds, const FrontendParams& params);

/// Whether a pose of this covariance of (ω, v) is certain within `max_drift_*` in every direction.
bool isKnown(const Matrix6d& covariance, const FrontendParams& params);

/// A pose and how it changes.
struct MotionState {
  using Covariance = Eigen::Matrix<double, 12, 12>;
  Eigen::Isometry3d map_from_body = Eigen::Isometry3d::Identity();
  Vector6d rate = Vector6d::Zero();            ///< of (ω, v), in the map's axes [rad/s, m/s]
  Covariance covariance = Covariance::Zero();  ///< of (ω, v, rate)

  Matrix6d poseCovariance() const { return covariance.topLeftCorner<6, 6>(); }
  Matrix6d rateCovariance() const { return covariance.bottomRightCorner<6, 6>(); }
  /// What is known of the pose, whatever the rate.
  PosePrior pose() const;
};

/// The same state in another frame.
MotionState inFrame(const Eigen::Isometry3d& frame_from_map, const MotionState& state);

/// What a body did between two scans: what a smoother needs of each step of the filter.
struct MotionStep {
  MotionState predicted;  ///< at the second scan, before it
  /// Of the state at the first scan (rows) with `predicted` (columns).
  MotionState::Covariance shared = MotionState::Covariance::Zero();
  MotionState found;  ///< at the second scan, with it
};

/// The same step in another frame.
MotionStep inFrame(const Eigen::Isometry3d& frame_from_map, const MotionStep& step);

/// Predicts the next pose: by the rawlog's odometry where there is one, else by constant velocity.
///
/// A Kalman filter of pose and velocity in (ω, v), see `retract`: a direction that scans do not fix
/// grows uncertain from prediction to prediction, until one fixes it again. Velocities change by
/// random accelerations (white, of the spectral density a²·0.1 s that a body has which changes an
/// acceleration of deviation a every 0.1 s). How far predictions were off of late tells how much
/// this body accelerates: at most as a typical one (adaptive estimation from innovations: Mehra,
/// IEEE Transactions on Automatic Control 15(2), 1970).
class MotionModel {
 public:
  explicit MotionModel(const FrontendParams& params) : params_(params) {}

  /// The body is at `pose`, exactly, with no known velocity; what was before is forgotten.
  void start(const StampedPose& pose, const std::optional<Eigen::Isometry3d>& odom_from_body);

  /// Takes note of the pose of a localized scan. `odom_from_body`: the odometry's pose at that
  /// time. `information`: what the scan says of the pose; a direction without is known as well as
  /// it was predicted. Before the start, this is the start, and the step is empty.
  MotionStep update(const StampedPose& pose, const std::optional<Eigen::Isometry3d>& odom_from_body,
                    const Matrix6d& information);

  /// Where the body should be at `timestamp`. Before the start: the identity, nothing known.
  PosePrior predict(double timestamp, const std::optional<Eigen::Isometry3d>& odom_from_body) const;

  /// The same with the rate. Before the start: the identity, without uncertainty.
  MotionState predictState(double timestamp,
                           const std::optional<Eigen::Isometry3d>& odom_from_body) const;

  /// What the scans up to the last one told.
  const MotionState& state() const { return last_; }

  /// The last known pose, as uncertain as it was and as the typical speeds allow at `timestamp`:
  /// for a body that did something unexpected.
  PosePrior lastPose(double timestamp) const;

  /// What motion alone tells of the pose at `timestamp` relative to the one of the last call of
  /// `setAnchor`: errors of odometry over the way between, or of the velocity then and of its
  /// changes since.
  Matrix6d informationSinceAnchor(double timestamp,
                                  const std::optional<Eigen::Isometry3d>& odom_from_body) const;
  /// Remembers the last known pose, which became a keyframe.
  void setAnchor();

  /// From now on poses are relative to the last one, which so is exact.
  void beginAtLastPose();

  /// The map has moved by an optimization and took the last pose to `last_pose`.
  void correct(const Eigen::Isometry3d& last_pose);

 private:
  friend struct StateAccess;  // checkpoints
  struct Anchor {
    double timestamp = 0.0;
    std::optional<Eigen::Isometry3d> odom_from_body;
    Matrix6d rate_covariance = Matrix6d::Zero();
  };

  MotionStep predictStep(double timestamp,
                         const std::optional<Eigen::Isometry3d>& odom_from_body) const;
  MotionStep carriedByOdometry(double step, const Eigen::Isometry3d& last_from_now) const;
  MotionStep carriedByVelocity(double step) const;
  Vector6d odometryVariance(const Eigen::Isometry3d& first_from_second) const;
  /// Spectral density of the accelerations [rad²/s³, m²/s³].
  Vector6d agility() const;
  /// Accelerations over those of a typical body: of rotation and translation, 0–1.
  Eigen::Vector2d unrest() const;
  /// Learns from how far a prediction was off, unless the scan leaves about as much open.
  void learn(const MotionState& predicted, const Eigen::Isometry3d& found,
             const Matrix6d& information);

  FrontendParams params_;
  bool started_ = false;
  double timestamp_ = 0.0;
  MotionState last_;
  std::optional<Eigen::Isometry3d> last_odom_from_body_;
  Anchor anchor_;
  Eigen::Vector2d squared_unrest_ = Eigen::Vector2d::Ones();  ///< as seen of late, see unrest()
};

}  // namespace opp::mapping
