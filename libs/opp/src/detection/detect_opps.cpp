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
    // Where detail is looked for, noise alone may blur layers.
    const double half = 0.5 * scene_.spacing;
    const double resolution =
        scene_.detail ? std::min(half, static_cast<double>(sample.gate)) : half;
    found.planes.push_back(
        {plane, anchor, static_cast<double>(fit.votes), scene_.radius, resolution});
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

/// Wide neighbourhoods; returns which samples no plane of at least `least` samples explains.
std::vector<std::uint8_t> voteWide(const OrientedCloud& cloud, int least, const SensorModel& sensor,
                                   const VotingParams& params, const VoteThresholds& thresholds,
                                   int threads, OppHypotheses& found) {
  const std::vector<VotingSample> samples = votingSamples(cloud, 0, sensor, params);
  OpenSamples open(samples, std::vector<std::uint8_t>(samples.size(), 1), params.normal_tolerance);
  VotingScene scene(samples, cloud.viewpoint, params, params.neighbourhood * cloud.spacing,
                    cloud.spacing);
  scene.detail = least > 0;
  detectInRounds(scene, thresholds, threads, open, found);
  open.reopen(least);
  return open.flags();
}

/// Samples of about the same extent, and which of them no plane explains.
struct Level {
  std::vector<VotingSample> samples;
  std::vector<std::uint8_t> open;

  double meanExtent() const {
    double sum = 0.0;
    for (const VotingSample& sample : samples) sum += static_cast<double>(sample.extent);
    return sum / static_cast<double>(samples.size());
  }
};

/// The samples by octaves of their extents, from `spacing` down.
std::vector<Level> levelsOf(const std::vector<VotingSample>& samples,
                            const std::vector<std::uint8_t>& open, double spacing) {
  constexpr int kLevels = 8;  // the last takes all below
  std::vector<Level> levels(kLevels);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double octave = std::log2(spacing / static_cast<double>(samples[i].extent));
    Level& level = levels[static_cast<std::size_t>(std::clamp(octave, 0.0, kLevels - 1.0))];
    level.samples.push_back(samples[i]);
    level.open.push_back(open[i]);
  }
  return levels;
}

/// Planes that fill little of the wide neighbourhood get few of its votes: what is left over votes
/// again among its nearest. All at once: few partners make poor planes, which must not close the
/// samples of better ones.
void voteNarrow(const std::vector<Level>& levels, const Eigen::Vector3f& viewpoint, bool detail,
                const VotingParams& params, const VoteThresholds& thresholds, int threads,
                OppHypotheses& found) {
  for (const Level& level : levels) {
    if (level.samples.size() < 3) continue;
    const OpenSamples open(level.samples, level.open, params.normal_tolerance);
    if (open.empty()) continue;
    const double extent = level.meanExtent();
    VotingScene scene(level.samples, viewpoint, params,
                      params.neighbourhood / params.narrowing * extent, extent);
    scene.detail = detail;
    std::vector<std::uint8_t> taken(level.samples.size(), 0);
    const auto references = open.take(scene.grid.order(), params.narrow_reference_points, taken);
    append(detectAtAll(scene, thresholds, references, threads), found);
  }
}

}  // namespace

OppHypotheses detectOpps(ScanSurface& surface, const SensorModel& sensor,
                         const VotingParams& params, int threads) {
  if (surface.patches.size() == 0) return detectOpps(surface.samples, sensor, params, threads);
  validate(params);
  const double spacing = surface.samples.spacing;
  if (surface.samples.size() < 3 || !(spacing > 0.0)) return {};
  OppHypotheses found;
  const VoteThresholds thresholds(params);
  const auto open =
      voteWide(surface.samples, params.detail_samples, sensor, params, thresholds, threads, found);
  // Detail votes with detail only: the rest of the scene is explained.
  const std::size_t begin = splitSamples(surface, open);
  const auto samples = votingSamples(surface.samples, begin, sensor, params);
  const std::vector<std::uint8_t> all(samples.size(), 1);
  voteNarrow(levelsOf(samples, all, spacing), surface.samples.viewpoint, true, params, thresholds,
             threads, found);
  return found;
}

OppHypotheses detectOpps(const OrientedCloud& cloud, const SensorModel& sensor,
                         const VotingParams& params, int threads) {
  validate(params);
  if (cloud.size() < 3 || !(cloud.spacing > 0.0)) return {};
  OppHypotheses found;
  const VoteThresholds thresholds(params);
  const auto open = voteWide(cloud, 0, sensor, params, thresholds, threads, found);
  const auto samples = votingSamples(cloud, 0, sensor, params);
  voteNarrow(levelsOf(samples, open, cloud.spacing), cloud.viewpoint, false, params, thresholds,
             threads, found);
  return found;
}

}  // namespace opp
