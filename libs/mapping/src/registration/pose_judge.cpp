// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/pose_judge.h"

#include "registration/pose_candidates.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp::mapping {
namespace {

/// Corners are the same if this near after alignment, in sample spacings.
constexpr double kCornerReach = 2.0;
/// Sample spacings that a refined pose may still be off.
constexpr double kRefinedSlack = 0.25;
/// A pose with less than this share of the best's confirming samples is a weak rival: the best need
/// be preferred to it only by this share of the clarity.
constexpr double kWeakShare = 0.5;
constexpr double kWeakClarity = 0.5;

/// Against the strongest of the other candidates.
double clarityOfBest(const std::vector<Candidate>& candidates) {
  double least = 1.0;
  for (std::size_t k = 1; k < candidates.size(); ++k) {
    least = std::min(least, clarity(candidates[0].verification, candidates[k].verification));
  }
  return least;
}

}  // namespace

PoseJudge::PoseJudge(const ScanModel& target, const ScanModel& source,
                     const GlobalAlignmentParams& params)
    : target_(target),
      source_(source),
      params_(params),
      refined_slack_(kRefinedSlack * std::max(target.cloud().spacing, source.cloud().spacing)),
      distinct_step_(params.distinct_cells * std::max(target.voxels.cell(), source.voxels.cell())) {
}

GlobalAlignment PoseJudge::judge(const std::vector<Candidate>& candidates) const {
  GlobalAlignment answer;
  for (const Candidate& c : candidates) {
    answer.hypotheses.push_back(
        {c.pose.target_from_source, c.score, c.verification.overlap(), c.verification.conflict()});
  }
  const Candidate& best = candidates.front();
  answer.overlap = best.verification.overlap();
  answer.rms = best.verification.rms();
  answer.corner_matches = cornerMatches(best.pose.target_from_source);
  answer.observed_dof = observedDof(best);
  answer.clarity = clarityOfBest(candidates);
  const Confirmation confirmation = confirmationOf(target_, source_, best);
  answer.confirmation = confirmation.share();
  answer.outcome = outcome(candidates, confirmation, answer);
  if (answer.outcome != AlignmentOutcome::kAligned) return answer;
  answer.target_from_source = best.pose.target_from_source;
  answer.covariance = covarianceAt(target_, source_, answer.target_from_source, params_);
  return answer;
}

AlignmentOutcome PoseJudge::outcome(const std::vector<Candidate>& candidates,
                                    const Confirmation& confirmation,
                                    const GlobalAlignment& answer) const {
  const Candidate& best = candidates.front();
  if (best.score <= 0.0 || answer.overlap < params_.min_overlap ||
      best.verification.conflict() > params_.max_conflict) {
    return AlignmentOutcome::kNoOverlap;
  }
  if (answer.observed_dof < 6) return AlignmentOutcome::kInsufficient;
  const bool ambiguous =
      std::any_of(candidates.begin() + 1, candidates.end(),
                  [&](const Candidate& other) { return rivals(best, confirmation, other); });
  return ambiguous ? AlignmentOutcome::kAmbiguous : AlignmentOutcome::kAligned;
}

/// Does the other pose explain the scans about as well? Three surfaces can be laid on three others
/// somewhere in any two rooms, so what agrees there is no evidence; a pose that has far less than
/// the best beyond them has to be nearly as good in all to be a rival.
bool PoseJudge::rivals(const Candidate& best, const Confirmation& confirmation,
                       const Candidate& other) const {
  const double advantage = clarity(best.verification, other.verification);
  if (advantage >= params_.min_clarity) return false;
  if (advantage < kWeakClarity * params_.min_clarity) return true;
  return confirmationOf(target_, source_, other).confirming >= kWeakShare * confirmation.confirming;
}

/// Degrees of freedom that enough samples see and in which the best pose cannot be moved by a
/// distinct step without the scans agreeing less: the continuous form of having no rival.
int PoseJudge::observedDof(const Candidate& best) const {
  // (ω, v) in units of the distinct rotation and translation, so that eigenvectors compare alike.
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(
      Matrix6d(units().asDiagonal() * best.pose.information * units().asDiagonal()));
  int firm = 0;
  for (int k = 0; k < 6; ++k) {
    const Vector6d step = units().cwiseProduct(eigen.eigenvectors().col(k));
    if (!slides(best, step) && !slides(best, -step)) ++firm;
  }
  const auto seen = (best.pose.observability.array() >= params_.min_observability).count();
  return std::min(firm, static_cast<int>(seen));
}

bool PoseJudge::slides(const Candidate& best, const Vector6d& step) const {
  const Eigen::Isometry3d moved = retract(best.pose.target_from_source, step);
  const Verification there = verifyPose(target_, source_, moved, refined_slack_, params_);
  return clarity(best.verification, there) < params_.min_slide_clarity;
}

Vector6d PoseJudge::units() const {
  Vector6d units;
  units << Eigen::Vector3d::Constant(params_.distinct_rotation),
      Eigen::Vector3d::Constant(distinct_step_);
  return units;
}

/// Corners that are each other's nearest, compatible and in reach.
std::vector<CornerMatch> PoseJudge::cornerMatches(
    const Eigen::Isometry3d& target_from_source) const {
  const int count_t = static_cast<int>(target_.primitives().corners.size());
  const int count_s = static_cast<int>(source_.primitives().corners.size());
  const auto distance = [&](int t, int s) { return cornerDistance(t, s, target_from_source); };
  std::vector<CornerMatch> matches;
  for (int t = 0; t < count_t; ++t) {
    int nearest = -1;
    for (int s = 0; s < count_s; ++s) {
      if (nearest < 0 || distance(t, s) < distance(t, nearest)) nearest = s;
    }
    if (nearest < 0 || !std::isfinite(distance(t, nearest))) continue;
    bool mutual = true;
    for (int other = 0; other < count_t && mutual; ++other) {
      mutual = other == t || distance(other, nearest) > distance(t, nearest);
    }
    if (mutual) matches.push_back({t, nearest});
  }
  return matches;
}

/// Distance of two corners after alignment [m]; infinite if they cannot be the same.
double PoseJudge::cornerDistance(int t, int s, const Eigen::Isometry3d& target_from_source) const {
  const Corner& fixed = target_.primitives().corners[static_cast<std::size_t>(t)];
  const Corner& moving = source_.primitives().corners[static_cast<std::size_t>(s)];
  const double distance = (target_from_source * moving.position - fixed.position).norm();
  const double reach = kCornerReach * std::max(target_.cloud().spacing, source_.cloud().spacing);
  const bool same = distance < reach && compatibleCorners(target_, fixed, source_, moving,
                                                          target_from_source.linear(), params_);
  return same ? distance : std::numeric_limits<double>::infinity();
}

}  // namespace opp::mapping
