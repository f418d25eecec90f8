// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/tracker.h"

#include "opp/geometry/constants.h"
#include "opp/geometry/median.h"
#include "opp/mapping/registration/align_globally.h"

#include "registration/observability.h"
#include "registration/scan_model.h"
#include "registration/verify_pose.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>
#include <utility>

namespace opp::mapping {

Tracker::Tracker(const MapperParams& params) : params_(params), motion_(params.frontend) {}

void Tracker::start(const StampedPose& pose,
                    const std::optional<Eigen::Isometry3d>& odom_from_body) {
  motion_.start(pose, odom_from_body);
  last_scan_ = pose.timestamp;
  follows_ = true;
  surprised_ = false;
  lost_.clear();
}

std::optional<PosePrior> Tracker::expected(
    double timestamp, const std::optional<Eigen::Isometry3d>& odom_from_body) const {
  if (surprised_) return std::nullopt;
  return motion_.predict(timestamp, odom_from_body);
}

namespace {

/// Whether motion speaks against a body that has turned around, by odds of 100 to 1. One scan
/// cannot tell a rectangular hall from the same hall turned around.
bool excludesHalfTurn(const PosePrior& prior) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> rotation(
      prior.information.topLeftCorner<3, 3>(), Eigen::EigenvaluesOnly);
  return kPi * kPi * rotation.eigenvalues()[0] >= kClearly;
}

/// Variance of the position in its worst direction [m²].
double positionVariance(const PosePrior& prior) {
  const Matrix6d covariance = prior.information.inverse();
  return largestVariance(covariance.bottomRightCorner<3, 3>());
}

/// Scans that tell how far apart scans usually are.
constexpr std::size_t kIntervals = 15;
/// A gap begins where so many of the usual intervals are missing.
constexpr double kSkipped = 2.0;

/// Standard deviation, in the finest voxels (and for turns the angles they fill at one metre), of a
/// prior that keeps registration where it begins.
constexpr double kNear = 0.2;

/// Whether a scan's samples lie farther apart (root mean square) at two poses than `distance`.
bool movesBeyond(double distance, const ScanFeatures& scan, const Eigen::Isometry3d& a,
                 const Eigen::Isometry3d& b) {
  double sum = 0.0;
  for (const Eigen::Vector3f& point : scan.cloud_in_body.points)
    sum += (a * point.cast<double>() - b * point.cast<double>()).squaredNorm();
  return sum > distance * distance * static_cast<double>(scan.cloud_in_body.size());
}

/// So far samples may be off between those of the other scan [m].
double slackBetween(const ScanFeatures& scan, const Keyframe& newest) {
  return std::max(newest.features.cloud_in_body.spacing, scan.cloud_in_body.spacing);
}

/// How a scan fares against the newest keyframe.
Verification verified(const Eigen::Isometry3d& map_from_body, const ScanFeatures& scan,
                      const Keyframe& newest, const MapperParams& params) {
  const SensorModel& sensor = params.primitives.sensor;
  return verifyPose(ScanModel(newest.features, sensor, params.global_alignment),
                    ScanModel(scan, sensor, params.global_alignment),
                    newest.map_from_body.inverse() * map_from_body, slackBetween(scan, newest),
                    params.global_alignment);
}

}  // namespace

void Tracker::takeTime(double timestamp) {
  if (intervals_.size() == kIntervals) intervals_.erase(intervals_.begin());
  intervals_.push_back(timestamp - std::exchange(last_scan_, timestamp));
}

/// Whether a prediction says enough to look for the body in the same map: rooms repeat. Scans that
/// are always far apart are not a gap.
bool Tracker::guides(const PosePrior& predicted) const {
  const double gap = std::max(params_.frontend.max_gap, kSkipped * medianOf(intervals_));
  const double farthest = gap * params_.frontend.speed;
  return positionVariance(predicted) <= farthest * farthest;
}

TrackResult Tracker::track(const ScanFeatures& scan,
                           const std::optional<Eigen::Isometry3d>& odom_from_body,
                           const MapState& map) {
  TrackResult result;
  if (!local_map_ || map.keyframes.empty()) return result;
  result.outcome = TrackOutcome::kEmptyScan;
  takeTime(scan.timestamp);
  if (scan.cloud_in_body.size() == 0) return result;

  const Keyframe& newest = map.keyframes.back();
  const PosePrior predicted = motion_.predict(scan.timestamp, odom_from_body);
  // Not by odometry: wheels slip, and that of a hand-held body may be a plane's.
  const PosePrior moved = motion_.lastPose(scan.timestamp);
  if (!guides(predicted)) {
    result.outcome = TrackOutcome::kForgotten;
    return result;
  }
  result = localize(scan, predicted, moved, newest);
  if (result.localized() && deniedByLostScans(lost_, scan, result.match.map_from_body, params_))
    result.outcome = TrackOutcome::kImplausible;
  const bool followed = std::exchange(follows_, result.localized());
  const bool lost = !result.localized() && result.outcome != TrackOutcome::kUnobserved;
  if (followed || !lost) surprised_ = lost && surprises(predicted, scan, newest);
  if (lost) {
    // A new map is begun after so many; where none can be, memory must not grow.
    if (lost_.size() == static_cast<std::size_t>(params_.loop.lost_scans))
      lost_.erase(lost_.begin());
    lost_.push_back({scan, predicted});
    return result;
  }
  lost_.clear();
  // Between keyframes, motion ties what neither planes nor points do.
  result.motion_information = motion_.informationSinceAnchor(scan.timestamp, odom_from_body);
  result.match.point_information += result.motion_information;
  motion_.update({scan.timestamp, result.match.map_from_body}, odom_from_body,
                 result.match.information);
  result.wants_keyframe = wantsKeyframe(result.match, newest);
  return result;
}

/// The ladder of DESIGN 3: prediction, then the last pose with no more known than how fast a body
/// moves, then no guess.
TrackResult Tracker::localize(const ScanFeatures& scan, const PosePrior& predicted,
                              const PosePrior& moved, const Keyframe& newest) const {
  TrackResult best;
  std::optional<std::optional<MatchResult>> near;  // see whereExpected; asked for once, if at all
  const auto better = [&](const PosePrior& prior) {
    MatchResult match = matchScan(scan, *local_map_, prior, params_.registration);
    if (leaps(match.map_from_body, predicted, scan)) {
      if (!near) near = whereExpected(scan, predicted, newest);
      if (*near) match = **near;
    }
    TrackOutcome outcome = outcomeOf(match, scan, moved, newest);
    // What motion does not predict must explain most of the scan: a wrong pose far off can agree
    // with a good part of a map, and with no direction left open.
    const bool expected = &prior == &predicted;
    if ((!expected || (!follows_ && outcome == TrackOutcome::kLocalized)) && !convincing(match))
      outcome = TrackOutcome::kLittleOverlap;
    if (slidAway(match, outcome, predicted, scan, newest) ||
        (surprised_ && !resumes(match.map_from_body, predicted, scan, newest)))
      outcome = TrackOutcome::kImplausible;
    const bool localized = outcome == TrackOutcome::kLocalized;
    if (best.outcome != TrackOutcome::kNoMap && best.localized() >= localized &&
        (best.localized() != localized || best.match.overlap >= match.overlap))
      return;
    best.outcome = outcome;
    best.match = std::move(match);
  };
  // One scan cannot tell a rectangular hall from the same hall turned around: where motion does not
  // either, only an alignment without rivals can.
  const bool guided = excludesHalfTurn(predicted);
  if (guided) {
    // Repeating rooms: what is likely and not contradicted goes before what agrees a little more.
    better(predicted);
    // What is open with a prediction is so without.
    if (best.localized() || best.outcome == TrackOutcome::kUnobserved) return best;
    better(moved);
    if (best.localized()) return best;
  }
  if (const auto start = relocalize(scan, moved, newest)) better(*start);
  if (!guided && !best.localized()) best.outcome = TrackOutcome::kForgotten;
  return best;
}

bool Tracker::leaps(const Eigen::Isometry3d& map_from_body, const PosePrior& predicted,
                    const ScanFeatures& scan) const {
  return predicted.squaredSigmas(map_from_body) > kClearly &&
         movesBeyond(local_map_->fine().voxelSize(), scan, predicted.map_from_body, map_from_body);
}

std::optional<MatchResult> Tracker::whereExpected(const ScanFeatures& scan,
                                                  const PosePrior& predicted,
                                                  const Keyframe& newest) const {
  // So little is left open that the finest surfels are looked for, and none far away.
  const double reach = kNear * local_map_->fine().voxelSize();
  PosePrior near;
  near.map_from_body = predicted.map_from_body;
  near.information = Matrix6d::Identity() / (reach * reach);
  MatchResult match = matchScan(scan, *local_map_, near, params_.registration);
  if (leaps(match.map_from_body, predicted, scan) || contradicts(match.map_from_body, scan, newest))
    return std::nullopt;
  match.covariance = covarianceOf(match.information + predicted.information);
  return match;
}

bool Tracker::convincing(const MatchResult& match) const {
  return match.overlap >= params_.frontend.doubtful_overlap;
}

TrackOutcome Tracker::outcomeOf(const MatchResult& match, const ScanFeatures& scan,
                                const PosePrior& moved, const Keyframe& newest) const {
  if (match.overlap < params_.frontend.min_overlap) return TrackOutcome::kLittleOverlap;
  const double max_jump = params_.frontend.max_jump;
  if (moved.squaredSigmas(match.map_from_body) > max_jump * max_jump)
    return TrackOutcome::kImplausible;
  // A wrong pose can agree with a good part of a map: the floor fits at many places.
  if (!convincing(match) && contradicts(match.map_from_body, scan, newest))
    return TrackOutcome::kContradicted;
  return isKnown(match.covariance, params_.frontend) ? TrackOutcome::kLocalized
                                                     : TrackOutcome::kUnobserved;
}

bool Tracker::contradicts(const Eigen::Isometry3d& map_from_body, const ScanFeatures& scan,
                          const Keyframe& newest) const {
  return verified(map_from_body, scan, newest, params_).conflict() >
         params_.global_alignment.max_conflict;
}

bool Tracker::surprises(const PosePrior& predicted, const ScanFeatures& scan,
                        const Keyframe& newest) const {
  const double max_drift = params_.frontend.max_drift_translation;
  return positionVariance(predicted) <= max_drift * max_drift &&
         verified(predicted.map_from_body, scan, newest, params_).conflict() >
             params_.frontend.surprising_conflict;
}

/// Little structure beside a bare wall can lead registration off along the wall, and a body that
/// was carried off may come to a place that looks much the same. What motion calls impossible must
/// leave little of the scan unexplained and no direction open, and do no worse than what motion
/// says. A jerk of less than what a sample may be off is followed: both poses agree with the same
/// samples but for a few, which fell to one or the other by chance.
bool Tracker::slidAway(const MatchResult& match, TrackOutcome outcome, const PosePrior& predicted,
                       const ScanFeatures& scan, const Keyframe& newest) const {
  if (predicted.squaredSigmas(match.map_from_body) <= kPossible ||
      !movesBeyond(slackBetween(scan, newest), scan, predicted.map_from_body, match.map_from_body))
    return false;
  return outcome == TrackOutcome::kUnobserved || match.overlap < params_.frontend.leap_overlap ||
         clarity(verified(match.map_from_body, scan, newest, params_),
                 verified(predicted.map_from_body, scan, newest, params_)) <
             -params_.global_alignment.min_slide_clarity;
}

/// The body may have been carried off: that one scan resembles the map at another pose is no proof,
/// least of all in a symmetric hall. Where motion expects it, and as free of conflict as what
/// alignment believes, what hid the map has passed.
bool Tracker::resumes(const Eigen::Isometry3d& map_from_body, const PosePrior& predicted,
                      const ScanFeatures& scan, const Keyframe& newest) const {
  return predicted.squaredSigmas(map_from_body) <= kClearly &&
         verified(map_from_body, scan, newest, params_).conflict() <=
             params_.global_alignment.max_conflict;
}

std::optional<PosePrior> Tracker::relocalize(const ScanFeatures& scan, const PosePrior& last,
                                             const Keyframe& newest) const {
  const GlobalAlignment alignment =
      alignGlobally(newest.features, scan, params_.primitives.sensor, params_.global_alignment);
  std::optional<Eigen::Isometry3d> pose;
  if (alignment.outcome == AlignmentOutcome::kAligned) {
    pose = newest.map_from_body * alignment.target_from_source;
  } else if (alignment.outcome == AlignmentOutcome::kAmbiguous ||
             alignment.outcome == AlignmentOutcome::kUnconfirmed) {
    std::vector<Eigen::Isometry3d> poses;
    for (const AlignmentHypothesis& h : alignment.hypotheses)
      poses.push_back(newest.map_from_body * h.target_from_source);
    pose = likeliest(poses, last);
  }
  // A start without weight: the alignment saw the same scan, so its information must not count
  // twice.
  if (!pose) return std::nullopt;
  return PosePrior{*pose, Matrix6d::Zero()};
}

bool Tracker::wantsKeyframe(const MatchResult& match, const Keyframe& newest) const {
  const Eigen::Isometry3d newest_from_now = newest.map_from_body.inverse() * match.map_from_body;
  return match.overlap < params_.frontend.keyframe_overlap ||
         rotationAngle(newest_from_now) > params_.frontend.keyframe_rotation;
}

std::optional<Eigen::Isometry3d> likeliest(const std::vector<Eigen::Isometry3d>& poses,
                                           const PosePrior& prior) {
  double best = std::numeric_limits<double>::infinity(), second = best;
  std::optional<Eigen::Isometry3d> result;
  for (const Eigen::Isometry3d& pose : poses) {
    const double squared_sigmas = prior.squaredSigmas(pose);
    if (squared_sigmas < best) {
      second = std::exchange(best, squared_sigmas);
      result = pose;
    } else {
      second = std::min(second, squared_sigmas);
    }
  }
  if (!(best <= kPossible) || second - best < kClearly) return std::nullopt;
  return result;
}

}  // namespace opp::mapping
