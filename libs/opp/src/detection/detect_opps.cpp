// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detection/detect_opps.h"

#include "opp/parallel/parallel_for.h"

#include "detection/fit_voters.h"
#include "detection/gather_hypotheses.h"
#include "detection/voting_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace opp {
namespace {

/// All hypotheses of one reference point.
void detectAt(const VotingScene& scene, std::uint32_t r, LocalVotes& votes, OppHypotheses& found) {
  castVotes(scene, r, votes);
  const int min_coplanar = scene.thresholds.coplanar[votes.pairs];
  if (static_cast<int>(votes.coplanar.size()) < min_coplanar) return;
  const VotingSample& sample = scene.samples[r];
  const Eigen::Vector3d x = sample.point.cast<double>(), n = sample.normal.cast<double>();
  const auto reference =
      fitVoters(scene, votes.coplanar, x, meanNormal(scene, votes.coplanar, n), min_coplanar);
  if (!reference) return;
  const int index = static_cast<int>(found.planes.size());
  found.planes.push_back(*reference);
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(n);
  for (;;) {
    const int min_votes = scene.thresholds.orthogonal[votes.orthogonal.votes()];
    const VotePeak peak = votes.orthogonal.takePeak();
    if (static_cast<int>(peak.voters.size()) < min_votes) return;
    const Eigen::Vector3d direction =
        tangents * Eigen::Vector2d(std::cos(peak.theta), std::sin(peak.theta));
    const Eigen::Vector3d normal = meanNormal(scene, peak.voters, direction);
    const auto partner =
        fitVoters(scene, peak.voters, densestHeight(scene, peak.voters, normal), normal, min_votes);
    if (!partner) continue;
    found.pairs.push_back({index, static_cast<int>(found.planes.size()), partner->votes});
    found.planes.push_back(*partner);
  }
}

void append(const OppHypotheses& part, OppHypotheses& all) {
  const int offset = static_cast<int>(all.planes.size());
  all.planes.insert(all.planes.end(), part.planes.begin(), part.planes.end());
  for (const OrthogonalPair& pair : part.pairs) {
    all.pairs.push_back({pair.reference + offset, pair.partner + offset, pair.votes});
  }
}

/// Appends the hypotheses of the given reference points.
void detectAtAll(const VotingScene& scene, const Voters& references, int threads,
                 OppHypotheses& all) {
  constexpr std::size_t kBlock = 32;  // reference points per task; results do not depend on it
  std::vector<OppHypotheses> parts((references.size() + kBlock - 1) / kBlock);
  parallelFor(parts.size(), threads, [&](std::size_t block) {
    LocalVotes votes(scene.params, scene.radius);
    const std::size_t end = std::min(references.size(), (block + 1) * kBlock);
    for (std::size_t k = block * kBlock; k < end; ++k) {
      detectAt(scene, references[k], votes, parts[block]);
    }
  });
  for (const OppHypotheses& part : parts) append(part, all);
}

/// At most `count` of the candidates, at equal steps. The grid's order runs cell by cell: equal
/// steps through it are even in space.
Voters evenly(const Voters& candidates, int count) {
  const std::size_t wanted = std::min(candidates.size(), static_cast<std::size_t>(count));
  Voters chosen;
  for (std::size_t k = 0; k < wanted; ++k) {
    chosen.push_back(candidates[(2 * k + 1) * candidates.size() / (2 * wanted)]);
  }
  return chosen;
}

/// Samples that lie on none of the planes found so far.
Voters unexplained(const VotingScene& scene, const OppHypotheses& found, double reach) {
  const double angle = scene.params.normal_tolerance;
  struct Candidate {
    Eigen::Vector3f normal;
    float d;
  };
  std::vector<Candidate> planes;
  for (const std::size_t leader : gatherHypotheses(found.planes, reach, angle).leaders) {
    const Plane& plane = found.planes[leader].plane;
    planes.push_back({plane.normal().cast<float>(), static_cast<float>(plane.d())});
  }
  const auto cosine = static_cast<float>(std::cos(angle));
  Voters left;
  for (std::uint32_t i = 0; i < scene.samples.size(); ++i) {
    const VotingSample& sample = scene.samples[i];
    const bool explained = std::any_of(planes.begin(), planes.end(), [&](const Candidate& plane) {
      return std::abs(plane.normal.dot(sample.point) + plane.d) < sample.gate &&
             std::abs(plane.normal.dot(sample.normal)) > cosine;
    });
    if (!explained) left.push_back(i);
  }
  return left;
}

}  // namespace

OppHypotheses detectOpps(const OrientedCloud& cloud, const SensorModel& sensor,
                         const VotingParams& params, int threads) {
  validate(params);
  if (cloud.size() < 3 || !(cloud.spacing > 0.0)) return {};
  OppHypotheses found;
  const double radius = params.neighbourhood * cloud.spacing;
  const VotingScene wide = makeVotingScene(cloud, sensor, params, radius);
  Voters all(cloud.size());
  std::iota(all.begin(), all.end(), 0U);
  detectAtAll(wide, evenly(all, params.reference_points), threads, found);
  // Planes that fill little of the wide neighbourhood get few of its votes: what is left over votes
  // again among its nearest.
  const VotingScene narrow = makeVotingScene(cloud, sensor, params, radius / params.narrowing);
  const Voters left = unexplained(narrow, found, 0.5 * cloud.spacing);
  detectAtAll(narrow, evenly(left, params.narrow_reference_points), threads, found);
  return found;
}

}  // namespace opp
