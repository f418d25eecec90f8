// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/align_globally.h"

#include "registration/pose_candidates.h"
#include "registration/refine_pose.h"
#include "registration/scan_model.h"
#include "registration/verify_pose.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace opp::mapping {
namespace {

/// Corners are the same if this near after alignment, in sample spacings.
constexpr double kCornerReach = 2.0;
/// Sample spacings that a refined pose may still be off, when it is verified.
constexpr double kRefinedSlack = 0.25;

struct Candidate {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  double score = 0.0;
  Verification verification;
  Matrix6d information = Matrix6d::Zero();
  Vector6d observability = Vector6d::Zero();
};

void requireUsable(const ScanFeatures& scan, const char* which) {
  if (scan.cloud_in_body.size() > 0 && !(scan.cloud_in_body.spacing > 0.0)) {
    throw std::invalid_argument(std::string("alignGlobally: the ") + which +
                                " has no sample spacing");
  }
  if (scan.primitives_in_body.labels.size() == scan.cloud_in_body.size()) return;
  throw std::invalid_argument(std::string("alignGlobally: the ") + which + " has " +
                              std::to_string(scan.primitives_in_body.labels.size()) +
                              " labels for " + std::to_string(scan.cloud_in_body.size()) +
                              " samples");
}

class Aligner {
 public:
  Aligner(const ScanFeatures& target, const ScanFeatures& source,
          const GlobalAlignmentParams& params)
      : params_(params),
        target_(target, params),
        source_(source, params),
        refined_slack_(kRefinedSlack * std::max(target_.cloud().spacing, source_.cloud().spacing)) {
  }

  GlobalAlignment run() {
    GlobalAlignment result;
    std::vector<Candidate> candidates = screened();
    if (candidates.empty()) return result;
    verify(candidates, 0.5 * target_.voxels.cell());
    candidates = distinct(std::move(candidates), static_cast<std::size_t>(params_.max_refined));
    for (Candidate& c : candidates) {
      const RefinedPose refined = refinePose(target_, source_, c.target_from_source, params_);
      c.target_from_source = refined.target_from_source;
      c.information = refined.information;
      c.observability = refined.observability;
    }
    verify(candidates, refined_slack_);
    candidates = distinct(std::move(candidates), candidates.size());
    report(candidates, result);
    return result;
  }

 private:
  /// Candidate poses that pass the first look, best first.
  std::vector<Candidate> screened() const {
    const auto min_cosine = static_cast<float>(std::cos(params_.normal_gate));
    const auto kept = static_cast<std::size_t>(params_.max_verified);
    std::vector<Candidate> best;
    int threshold = 1;
    for (const RotationCandidate& r : rotationCandidates(target_, source_, params_)) {
      Candidate c;
      c.target_from_source.linear() = r.target_from_source;
      for (const Eigen::Vector3d& t :
           translationCandidates(target_, source_, r.target_from_source, params_)) {
        c.target_from_source.translation() = t;
        const int agreeing =
            screenPose(target_, source_, c.target_from_source.cast<float>(), min_cosine, threshold);
        if (agreeing < threshold) continue;
        c.score = agreeing;
        best.push_back(c);
        if (best.size() < 4 * kept) continue;
        keepBest(kept, best);
        threshold = static_cast<int>(best.back().score) + 1;
      }
    }
    keepBest(kept, best);
    return best;
  }

  static void keepBest(std::size_t count, std::vector<Candidate>& candidates) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    if (candidates.size() > count) candidates.resize(count);
  }

  void verify(std::vector<Candidate>& candidates, double slack) const {
    for (Candidate& c : candidates) {
      c.verification = verifyPose(target_, source_, c.target_from_source, slack, params_);
      c.score = c.verification.score();
    }
    keepBest(candidates.size(), candidates);
  }

  /// The best of each group of poses that are the same for our purpose. \param candidates best
  /// first
  std::vector<Candidate> distinct(std::vector<Candidate> candidates, std::size_t count) const {
    std::vector<Candidate> result;
    for (const Candidate& c : candidates) {
      if (result.size() == count) break;
      const bool known = std::any_of(result.begin(), result.end(), [&](const Candidate& other) {
        return same(c.target_from_source, other.target_from_source);
      });
      if (!known) result.push_back(c);
    }
    return result;
  }

  bool same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const {
    const Eigen::Isometry3d difference = a.inverse() * b;
    if (rotationAngle(difference) > params_.distinct_rotation) return false;
    const Eigen::Vector3d middle = source_.cloud().points.front().cast<double>();
    return (a * middle - b * middle).norm() < params_.distinct_translation;
  }

  void report(const std::vector<Candidate>& candidates, GlobalAlignment& result) const {
    for (const Candidate& c : candidates) {
      result.hypotheses.push_back(
          {c.target_from_source, c.score, c.verification.overlap(), c.verification.conflict()});
    }
    const Candidate& best = candidates.front();
    result.overlap = best.verification.overlap();
    result.rms = best.verification.rms();
    result.corner_matches = cornerMatches(best.target_from_source);
    if (best.score <= 0.0 || result.overlap < params_.min_overlap ||
        best.verification.conflict() > params_.max_conflict) {
      result.outcome = AlignmentOutcome::kNoOverlap;
      return;
    }
    result.observed_dof = observedDof(best);
    result.clarity = clarityOfBest(candidates);
    if (result.observed_dof < 6) {
      result.outcome = AlignmentOutcome::kInsufficient;
    } else if (result.clarity < params_.min_clarity) {
      result.outcome = AlignmentOutcome::kAmbiguous;
    } else {
      result.outcome = AlignmentOutcome::kAligned;
      result.target_from_source = best.target_from_source;
      result.covariance = best.information.inverse();
    }
  }

  /// Against the strongest of the other candidates.
  static double clarityOfBest(const std::vector<Candidate>& candidates) {
    double least = 1.0;
    for (std::size_t k = 1; k < candidates.size(); ++k) {
      least = std::min(least, clarity(candidates[0].verification, candidates[k].verification));
    }
    return least;
  }

  /// Degrees of freedom that enough samples see and in which the best pose cannot be moved by a
  /// distinct step without the scans agreeing less: the continuous form of having no rival.
  int observedDof(const Candidate& best) const {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scaled(best.information));
    int firm = 0;
    for (int k = 0; k < 6; ++k) {
      const Vector6d step = unscaled(eigen.eigenvectors().col(k));
      if (!slides(best, step) && !slides(best, -step)) ++firm;
    }
    const auto seen = (best.observability.array() >= params_.min_observability).count();
    return std::min(firm, static_cast<int>(seen));
  }

  bool slides(const Candidate& best, const Vector6d& step) const {
    const Eigen::Isometry3d moved = retract(best.target_from_source, step);
    const Verification there = verifyPose(target_, source_, moved, refined_slack_, params_);
    return clarity(best.verification, there) < params_.min_slide_clarity;
  }

  /// (ω, v) in units of the distinct rotation and translation, so that eigenvectors compare alike.
  Matrix6d scaled(const Matrix6d& information) const {
    const Vector6d units = scales();
    return units.asDiagonal() * information * units.asDiagonal();
  }
  Vector6d unscaled(const Vector6d& step) const { return scales().cwiseProduct(step); }
  Vector6d scales() const {
    Vector6d units;
    units << Eigen::Vector3d::Constant(params_.distinct_rotation),
        Eigen::Vector3d::Constant(params_.distinct_translation);
    return units;
  }

  /// Corners that are each other's nearest, compatible and in reach.
  std::vector<CornerMatch> cornerMatches(const Eigen::Isometry3d& target_from_source) const {
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
  double cornerDistance(int t, int s, const Eigen::Isometry3d& target_from_source) const {
    const Corner& fixed = target_.primitives().corners[static_cast<std::size_t>(t)];
    const Corner& moving = source_.primitives().corners[static_cast<std::size_t>(s)];
    const double distance = (target_from_source * moving.position - fixed.position).norm();
    const double reach = kCornerReach * std::max(target_.cloud().spacing, source_.cloud().spacing);
    const bool same = distance < reach && compatibleCorners(target_, fixed, source_, moving,
                                                            target_from_source.linear(), params_);
    return same ? distance : std::numeric_limits<double>::infinity();
  }

  const GlobalAlignmentParams& params_;
  ScanModel target_;
  ScanModel source_;
  double refined_slack_;
};

}  // namespace

std::string_view describe(AlignmentOutcome outcome) {
  switch (outcome) {
    case AlignmentOutcome::kAligned:
      return "aligned";
    case AlignmentOutcome::kAmbiguous:
      return "several distinct poses explain the scans about equally well";
    case AlignmentOutcome::kInsufficient:
      return "what the scans share does not fix all six degrees of freedom";
    case AlignmentOutcome::kNoOverlap:
      break;
  }
  return "no pose explains enough of the scans";
}

GlobalAlignment alignGlobally(const ScanFeatures& target, const ScanFeatures& source,
                              const GlobalAlignmentParams& params) {
  validate(params);
  requireUsable(target, "target");
  requireUsable(source, "source");
  if (target.cloud_in_body.size() == 0 || source.cloud_in_body.size() == 0) return {};
  return Aligner(target, source, params).run();
}

}  // namespace opp::mapping
