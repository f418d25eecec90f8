// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/align_globally.h"

#include "registration/pose_candidates.h"
#include "registration/pose_judge.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace opp::mapping {
namespace {

void requireUsable(const ScanFeatures& scan, const char* which) {
  if (scan.cloud_in_body.size() > 0 && !(scan.cloud_in_body.spacing > 0.0)) {
    throw std::invalid_argument(std::string("the ") + which +
                                " of an alignment has no sample "
                                "spacing");
  }
  if (scan.primitives_in_body.labels.size() == scan.cloud_in_body.size()) return;
  throw std::invalid_argument(std::string("the ") + which + " of an alignment has " +
                              std::to_string(scan.primitives_in_body.labels.size()) +
                              " labels for " + std::to_string(scan.cloud_in_body.size()) +
                              " samples");
}

Eigen::Vector3d middleOf(const OrientedCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : cloud.points) sum += p.cast<double>();
  return sum / static_cast<double>(cloud.size());
}

/// Sides of surfaces count only if both scans know them.
AlignmentInput withSides(AlignmentInput input, bool sided) {
  input.sided = sided;
  return input;
}

class Aligner {
 public:
  Aligner(const AlignmentInput& target, const AlignmentInput& source, const SensorModel& sensor,
          const GlobalAlignmentParams& params)
      : params_(params),
        target_(withSides(target, target.sided && source.sided), sensor, params),
        source_(withSides(source, target.sided && source.sided), sensor, params),
        judge_(target_, source_, params),
        middle_of_source_(middleOf(source_.cloud())) {}

  GlobalAlignment searched() const {
    std::vector<Candidate> candidates = screened();
    if (candidates.empty()) return {};
    verify(candidates, 0.5 * std::max(target_.voxels.cell(), source_.voxels.cell()));
    candidates = distinct(std::move(candidates), static_cast<std::size_t>(params_.max_refined));
    for (Candidate& c : candidates) {
      c.pose = refinePose(target_, source_, c.pose.target_from_source, params_);
    }
    verify(candidates, judge_.refinedSlack());
    const std::size_t all = candidates.size();
    candidates = distinct(std::move(candidates), all);
    GlobalAlignment answer = judge_.judge(candidates);
    if (answer.outcome == AlignmentOutcome::kAligned && !confirmed(candidates.front(), answer)) {
      answer.outcome = AlignmentOutcome::kUnconfirmed;
      answer.target_from_source = Eigen::Isometry3d::Identity();
      answer.covariance = Matrix6d::Zero();
    }
    return answer;
  }

  /// Of one pose that was refined or is to stay.
  GlobalAlignment judged(const Eigen::Isometry3d& target_from_source, bool refine) const {
    std::vector<Candidate> only(1);
    only[0].pose = refine ? refinePose(target_, source_, target_from_source, params_)
                          : informationAt(target_, source_, target_from_source, params_);
    verify(only, judge_.refinedSlack());
    return judge_.judge(only);
  }

 private:
  /// Candidate poses that pass the first look, best first.
  std::vector<Candidate> screened() const {
    // The smaller scan is looked for in the larger one.
    if (source_.area <= target_.area) return screened(target_, source_);
    std::vector<Candidate> candidates = screened(source_, target_);
    for (Candidate& c : candidates) c.pose.target_from_source = c.pose.target_from_source.inverse();
    return candidates;
  }

  std::vector<Candidate> screened(const ScanModel& fixed, const ScanModel& moving) const {
    const auto min_cosine = static_cast<float>(std::cos(params_.normal_gate));
    const auto kept = static_cast<std::size_t>(params_.max_verified);
    std::vector<Candidate> best;
    int threshold = 1;
    for (const RotationCandidate& r : rotationCandidates(fixed, moving, params_)) {
      Candidate c;
      c.pose.target_from_source.linear() = r.target_from_source;
      for (const Eigen::Vector3d& t :
           translationCandidates(fixed, moving, r.target_from_source, params_)) {
        c.pose.target_from_source.translation() = t;
        const int agreeing = screenPose(fixed, moving, c.pose.target_from_source.cast<float>(),
                                        min_cosine, threshold);
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
      c.verification = verifyPose(target_, source_, c.pose.target_from_source, slack, params_);
      c.score = c.verification.score();
    }
    keepBest(candidates.size(), candidates);
  }

  /// The best of each group of poses that are the same for our purpose. \param candidates best
  /// first
  std::vector<Candidate> distinct(std::vector<Candidate> candidates, std::size_t count) const {
    std::vector<Candidate> result;
    for (Candidate& c : candidates) {
      if (result.size() == count) break;
      const bool known = std::any_of(result.begin(), result.end(), [&](const Candidate& other) {
        return same(c.pose.target_from_source, other.pose.target_from_source);
      });
      if (!known) result.push_back(std::move(c));
    }
    return result;
  }

  bool same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const {
    return rotationAngle(a.inverse() * b) <= params_.distinct_rotation &&
           (a * middle_of_source_ - b * middle_of_source_).norm() < judge_.distinctStep();
  }

  /// Something beyond the surfaces that fix the pose speaks for it, or both scans are nearly the
  /// same view, so that what was not seen speaks, too.
  bool confirmed(const Candidate& best, const GlobalAlignment& answer) const {
    return answer.confirmation >= params_.min_confirmation ||
           std::min(best.verification.of_source.overlap(), best.verification.of_target.overlap()) >=
               params_.same_view_overlap;
  }

  const GlobalAlignmentParams& params_;
  ScanModel target_;
  ScanModel source_;
  PoseJudge judge_;
  Eigen::Vector3d middle_of_source_;
};

/// The answer of `ask`, unless there is nothing to ask about.
template <typename Ask>
GlobalAlignment answerOf(const AlignmentInput& target, const AlignmentInput& source,
                         const SensorModel& sensor, const GlobalAlignmentParams& params, Ask ask) {
  validate(params);
  validate(sensor);
  requireUsable(*target.features, "target");
  requireUsable(*source.features, "source");
  if (target.features->cloud_in_body.size() == 0 || source.features->cloud_in_body.size() == 0) {
    return {};
  }
  return ask(Aligner(target, source, sensor, params));
}

}  // namespace

std::string_view describe(AlignmentOutcome outcome) {
  switch (outcome) {
    case AlignmentOutcome::kAligned:
      return "aligned";
    case AlignmentOutcome::kAmbiguous:
      return "several distinct poses explain the scans about equally well";
    case AlignmentOutcome::kInsufficient:
      return "what the scans share does not fix all six degrees of freedom";
    case AlignmentOutcome::kUnconfirmed:
      return "the scans share three surfaces, as any two corners of rooms do, and nothing confirms "
             "that it is the same corner";
    case AlignmentOutcome::kNoOverlap:
      break;
  }
  return "no pose explains enough of the scans";
}

GlobalAlignment alignGlobally(const AlignmentInput& target, const AlignmentInput& source,
                              const SensorModel& sensor, const GlobalAlignmentParams& params) {
  return answerOf(target, source, sensor, params,
                  [](const Aligner& aligner) { return aligner.searched(); });
}

GlobalAlignment alignNear(const AlignmentInput& target, const AlignmentInput& source,
                          const Eigen::Isometry3d& target_from_source, const SensorModel& sensor,
                          const GlobalAlignmentParams& params) {
  return answerOf(target, source, sensor, params,
                  [&](const Aligner& aligner) { return aligner.judged(target_from_source, true); });
}

GlobalAlignment judgePose(const AlignmentInput& target, const AlignmentInput& source,
                          const Eigen::Isometry3d& target_from_source, const SensorModel& sensor,
                          const GlobalAlignmentParams& params) {
  return answerOf(target, source, sensor, params, [&](const Aligner& aligner) {
    return aligner.judged(target_from_source, false);
  });
}

}  // namespace opp::mapping
