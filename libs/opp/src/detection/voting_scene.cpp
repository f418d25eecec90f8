// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detection/voting_scene.h"

#include "opp/detection/pair_feature.h"
#include "opp/geometry/constants.h"
#include "opp/geometry/plane.h"

#include <cmath>

namespace opp {
namespace {

VoteThresholds makeThresholds(const VotingParams& params) {
  VoteThresholds thresholds;
  const double bins = static_cast<double>(params.theta_bins) * params.rho_bins;
  // A random normal is parallel within δ with probability 1 − cos δ; a random direction d is within
  // δ of the plane with probability sin δ.
  const double coplanar =
      (1.0 - std::cos(params.normal_tolerance)) * std::sin(params.normal_tolerance);
  // Random places in a disc fall into the 3 × 3 bins about ρ = 0 with density 4/π of the average.
  const double orthogonal = 9.0 / bins * 4.0 / kPi;
  for (int pairs = 0; pairs <= params.partners; ++pairs) {
    thresholds.coplanar.push_back(significantVotes(coplanar * pairs, 1.0, params.false_alarms));
    thresholds.orthogonal.push_back(
        significantVotes(orthogonal * pairs, bins, params.false_alarms));
  }
  return thresholds;
}

/// The reference point of one accumulator and what its pairs are tested with.
struct Reference {
  const VotingSample& sample;
  Eigen::Matrix<float, 3, 2> tangents;  ///< first two rows of R_z, transposed
  PairTest test;
  float squared_radius;
};

/// Sorts the pair with sample `j` into coplanar, orthogonal or neither.
void castVote(const VotingScene& scene, const Reference& reference, std::uint32_t j,
              LocalVotes& votes) {
  const VotingSample& partner = scene.samples[j];
  const PairFeature feature =
      pairFeature(reference.sample.point, reference.sample.normal, partner.point, partner.normal);
  if (!(feature.squared_distance < reference.squared_radius) || feature.squared_distance <= 0.0F) {
    return;
  }
  ++votes.pairs;
  if (reference.test.orthogonal(feature)) {
    // Eq. 3 and 4.
    const Eigen::Vector2f direction = reference.tangents.transpose() * partner.normal;
    votes.orthogonal.cast(std::atan2(direction.y(), direction.x()), feature.partner, j);
  } else if (reference.test.coplanar(feature)) {
    votes.coplanar.push_back(j);
  }
}

}  // namespace

VotingScene makeVotingScene(const OrientedCloud& cloud, const SensorModel& sensor,
                            const VotingParams& params, double radius) {
  // Cells of half the radius: most of what they hold is inside the ball, and they are few.
  VotingScene scene{
      params,
      radius,
      NeighbourhoodGrid(cloud.points, 0.5 * radius, static_cast<std::uint64_t>(params.seed)),
      {},
      makeThresholds(params),
      cloud.viewpoint.cast<double>()};
  scene.samples.reserve(cloud.size());
  for (const std::uint32_t i : scene.grid.order()) {
    const double sigma = sensor.meanSigma(static_cast<double>(cloud.sigmas[i]),
                                          static_cast<double>(cloud.weights[i]));
    const double gate = params.noise_gate * sigma + params.flatness * cloud.spacing;
    scene.samples.push_back({cloud.points[i], cloud.normals[i], static_cast<float>(gate)});
  }
  return scene;
}

void castVotes(const VotingScene& scene, std::uint32_t r, LocalVotes& votes) {
  const VotingSample& sample = scene.samples[r];
  const Reference reference{sample, tangentBasis(sample.normal.cast<double>()).cast<float>(),
                            PairTest(scene.params.normal_tolerance),
                            static_cast<float>(scene.radius * scene.radius)};
  votes.orthogonal.clear();
  votes.coplanar.clear();
  votes.cells.clear();
  votes.pairs = 0;
  scene.grid.cellsNear(sample.point, scene.radius, votes.cells);
  std::uint64_t candidates = 0;
  for (const auto& cell : votes.cells) candidates += cell.size();
  const auto wanted = static_cast<std::uint64_t>(scene.params.partners);
  // Each cell gives its share, rounded so that the shares add up to min(K, candidates). A stretch
  // that starts at another place for each reference point makes their draws differ.
  std::uint64_t seen = 0, drawn = 0;
  for (const auto& cell : votes.cells) {
    seen += cell.size();
    const std::uint64_t due = candidates <= wanted ? seen : seen * wanted / candidates;
    std::uint32_t j = cell.begin + r % cell.size();
    for (; drawn < due; ++drawn) {
      castVote(scene, reference, j, votes);
      if (++j == cell.end) j = cell.begin;
    }
  }
}

}  // namespace opp
