// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detection/detect_opps.h"

#include "opp/parallel/parallel_for.h"

#include "detection/fit_voters.h"
#include "detection/local_votes.h"
#include "detection/open_samples.h"
#include "detection/voting_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace opp {
namespace {

/// All hypotheses of one reference point after another.
class Detector {
 public:
  Detector(const VotingScene& scene, const VoteThresholds& thresholds)
      : scene_(scene),
        thresholds_(thresholds),
        votes_(scene),
        voters_(scene.params.partners),
        fitter_(scene.params.partners) {}

  void detectAt(std::uint32_t r, OppHypotheses& found) {
    votes_.pairUp(r);
    const int min_coplanar = thresholds_.coplanar[votes_.pairs];
    if (votes_.coplanar.size < min_coplanar) return;
    const VotingSample& sample = scene_.samples[r];
    const Eigen::Vector3d n = sample.normal.cast<double>();
    const auto reference = fitter_.fit(votes_.coplanar, Eigen::Vector3d::Zero(),
                                       meanNormal(votes_.coplanar, n), min_coplanar);
    if (!reference) return;
    const int index = add(*reference, sample, found);
    const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(n);
    votes_.castOrthogonal(tangents.cast<float>());
    for (;;) {
      const int min_votes = thresholds_.orthogonal[votes_.table.votes()];
      if (!votes_.table.takePeak(min_votes, peak_)) return;
      const auto partner = fitPeak(tangents, min_votes);
      if (!partner) continue;
      const int partner_index = add(*partner, sample, found);
      found.pairs.push_back({index, partner_index, static_cast<double>(partner->votes)});
    }
  }

 private:
  std::optional<VotersFit> fitPeak(const Eigen::Matrix<double, 3, 2>& tangents, int min_votes) {
    voters_.size = 0;
    for (const std::uint32_t k : peak_.voters) {
      voters_.add(votes_.partners, static_cast<Eigen::Index>(k));
    }
    const Eigen::Vector3d direction =
        tangents * Eigen::Vector2d(std::cos(peak_.theta), std::sin(peak_.theta));
    const Eigen::Vector3d normal = meanNormal(voters_, direction);
    return fitter_.fit(voters_, densestHeight(voters_, normal) * normal, normal, min_votes);
  }

  /// Appends the plane in the cloud's frame; returns its index.
  int add(const VotersFit& fit, const VotingSample& sample, OppHypotheses& found) const {
    const Eigen::Vector3d anchor = sample.point.cast<double>() + fit.mean;
    Plane plane = Plane::fromPointNormal(anchor, fit.plane.normal());
    if (plane.signedDistance(scene_.viewpoint) < 0.0) plane = plane.flipped();
    found.planes.push_back({plane, anchor, static_cast<double>(fit.votes)});
    return static_cast<int>(found.planes.size()) - 1;
  }

  const VotingScene& scene_;
  const VoteThresholds& thresholds_;
  LocalVotes votes_;
  VotePeak peak_;
  Partners voters_;
  VoterFitter fitter_;
};

void append(const OppHypotheses& part, OppHypotheses& all) {
  const int offset = static_cast<int>(all.planes.size());
  all.planes.insert(all.planes.end(), part.planes.begin(), part.planes.end());
  for (const OrthogonalPair& pair : part.pairs) {
    all.pairs.push_back({pair.reference + offset, pair.partner + offset, pair.votes});
  }
}

/// The hypotheses of the given reference points.
OppHypotheses detectAtAll(const VotingScene& scene, const VoteThresholds& thresholds,
                          const std::vector<std::uint32_t>& references, int threads) {
  constexpr std::size_t kBlock = 16;  // reference points per task; results do not depend on it
  std::vector<OppHypotheses> parts((references.size() + kBlock - 1) / kBlock);
  parallelFor(parts.size(), threads, [&](std::size_t block) {
    Detector detector(scene, thresholds);
    const std::size_t end = std::min(references.size(), (block + 1) * kBlock);
    for (std::size_t k = block * kBlock; k < end; ++k) {
      detector.detectAt(references[k], parts[block]);
    }
  });
  OppHypotheses all;
  for (const OppHypotheses& part : parts) append(part, all);
  return all;
}

/// Rounds of at most `reference_points` in all, each spread over the samples that the planes of the
/// rounds before left open, until one closes fewer samples than it had reference points.
void detectInRounds(const VotingScene& scene, const VoteThresholds& thresholds, int threads,
                    OpenSamples& open, OppHypotheses& found) {
  std::vector<std::uint8_t> taken(scene.samples.size(), 0);
  const int round_size = scene.params.round_size;
  for (int left = scene.params.reference_points; left > 0; left -= round_size) {
    const auto references = open.take(scene.grid.order(), std::min(left, round_size), taken);
    const OppHypotheses round = detectAtAll(scene, thresholds, references, threads);
    append(round, found);
    if (open.close(round.planes) < references.size() || references.empty()) return;
  }
}

}  // namespace

OppHypotheses detectOpps(const OrientedCloud& cloud, const SensorModel& sensor,
                         const VotingParams& params, int threads) {
  validate(params);
  if (cloud.size() < 3 || !(cloud.spacing > 0.0)) return {};
  OppHypotheses found;
  const VoteThresholds thresholds(params);
  const std::vector<VotingSample> samples = votingSamples(cloud, sensor, params);
  const double radius = params.neighbourhood * cloud.spacing;
  OpenSamples open(samples, 0.5 * cloud.spacing, params.normal_tolerance);
  detectInRounds(VotingScene(cloud, samples, params, radius), thresholds, threads, open, found);
  if (open.empty() || params.narrow_reference_points == 0) return found;
  // Planes that fill little of the wide neighbourhood get few of its votes: what is left over votes
  // again among its nearest. All at once: few partners make poor planes, which must not close the
  // samples of better ones.
  const VotingScene narrow(cloud, samples, params, radius / params.narrowing);
  std::vector<std::uint8_t> taken(samples.size(), 0);
  const auto references = open.take(narrow.grid.order(), params.narrow_reference_points, taken);
  append(detectAtAll(narrow, thresholds, references, threads), found);
  return found;
}

}  // namespace opp
