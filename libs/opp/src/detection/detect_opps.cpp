// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detection/detect_opps.h"

#include "opp/detection/neighbourhood_grid.h"
#include "opp/detection/pair_feature.h"
#include "opp/detection/vote_table.h"
#include "opp/geometry/constants.h"
#include "opp/parallel/parallel_for.h"

#include "detection/local_plane_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace opp {
namespace {

using Voters = std::vector<std::uint32_t>;

/// Samples in the grid's order, so that partners lie side by side in memory.
struct Sample {
  Eigen::Vector3f point, normal;
  float gate;  ///< [m] largest distance from its plane
};

/// Votes needed against clutter, by the number of pairs that could have voted.
struct Thresholds {
  std::vector<int> coplanar, orthogonal;
};

struct Scene {
  const VotingParams& params;
  double radius;  ///< τ_d [m]
  NeighbourhoodGrid grid;
  std::vector<Sample> samples;
  Eigen::Vector3d viewpoint;
  Thresholds thresholds;
};

/// Buffers of one thread.
struct Workspace {
  VoteTable table;
  Voters coplanar;
  std::vector<NeighbourhoodGrid::Range> cells;
};

Thresholds makeThresholds(const VotingParams& params) {
  Thresholds thresholds;
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

Scene makeScene(const OrientedCloud& cloud, const SensorModel& sensor, const VotingParams& params) {
  const double radius = params.neighbourhood * cloud.spacing;
  // Cells of half the radius: most of what they hold is inside the ball, and they are few.
  Scene scene{
      params,
      radius,
      NeighbourhoodGrid(cloud.points, 0.5 * radius, static_cast<std::uint64_t>(params.seed)),
      {},
      cloud.viewpoint.cast<double>(),
      makeThresholds(params)};
  scene.samples.reserve(cloud.size());
  for (const std::uint32_t i : scene.grid.order()) {
    const double sigma = sensor.meanSigma(static_cast<double>(cloud.sigmas[i]),
                                          static_cast<double>(cloud.weights[i]));
    const double gate = params.noise_gate * sigma + params.flatness * cloud.spacing;
    scene.samples.push_back({cloud.points[i], cloud.normals[i], static_cast<float>(gate)});
  }
  return scene;
}

/// Sorts the partner `j` of the reference point into coplanar, orthogonal or neither.
void vote(const Scene& scene, const Sample& reference, const Eigen::Matrix<float, 3, 2>& tangents,
          const PairTest& test, std::uint32_t j, Workspace& work) {
  const Sample& partner = scene.samples[j];
  const PairFeature feature =
      pairFeature(reference.point, reference.normal, partner.point, partner.normal);
  if (feature.distance >= static_cast<float>(scene.radius) || feature.distance <= 0.0F) return;
  if (test.orthogonal(feature)) {
    // Eq. 3 and 4; the tangents are the first two rows of R_z.
    const Eigen::Vector2f direction = tangents.transpose() * partner.normal;
    work.table.cast(std::atan2(direction.y(), direction.x()), feature.partner, j);
  } else if (test.coplanar(feature)) {
    work.coplanar.push_back(j);
  }
}

/// Pairs the reference point with ≤ K partners drawn evenly from the cells about it. Returns the
/// number of pairs.
int castVotes(const Scene& scene, std::uint32_t r, Workspace& work) {
  const Sample& reference = scene.samples[r];
  const Eigen::Matrix<float, 3, 2> tangents =
      tangentBasis(reference.normal.cast<double>()).cast<float>();
  const PairTest test{static_cast<float>(std::sin(scene.params.normal_tolerance)),
                      static_cast<float>(std::cos(scene.params.normal_tolerance))};
  work.table.clear();
  work.coplanar.clear();
  work.cells.clear();
  scene.grid.cellsNear(reference.point, scene.radius, work.cells);
  std::uint64_t candidates = 0;
  for (const auto& cell : work.cells) candidates += cell.size();
  const auto wanted = static_cast<std::uint64_t>(scene.params.partners);
  // Each cell gives its share, rounded so that the shares add up to min(K, candidates). A stretch
  // that starts at another place for each reference point makes their draws differ.
  std::uint64_t seen = 0, drawn = 0;
  for (const auto& cell : work.cells) {
    seen += cell.size();
    const std::uint64_t due = candidates <= wanted ? seen : seen * wanted / candidates;
    std::uint32_t j = cell.begin + r % cell.size();
    for (; drawn < due; ++drawn) {
      vote(scene, reference, tangents, test, j, work);
      if (++j == cell.end) j = cell.begin;
    }
  }
  return static_cast<int>(drawn);
}

/// Mean of the voters' normals, each turned to the side of `start`.
Eigen::Vector3d meanNormal(const Scene& scene, const Voters& voters, const Eigen::Vector3d& start) {
  Eigen::Vector3d sum = start;
  for (const std::uint32_t j : voters) {
    const Eigen::Vector3d normal = scene.samples[j].normal.cast<double>();
    sum += normal.dot(start) < 0.0 ? Eigen::Vector3d(-normal) : normal;
  }
  return sum.normalized();
}

/// The voter whose height over the plane through the origin with `normal` is nearest to most
/// others: mode of the heights, so that parallel surfaces within one peak do not mix.
Eigen::Vector3d densestHeight(const Scene& scene, const Voters& voters,
                              const Eigen::Vector3d& normal) {
  std::vector<std::pair<float, std::uint32_t>> heights;
  const Eigen::Vector3f direction = normal.cast<float>();
  for (const std::uint32_t j : voters) {
    heights.emplace_back(direction.dot(scene.samples[j].point), j);
  }
  std::sort(heights.begin(), heights.end());
  std::size_t first = 0, best_size = 0, best = 0;
  for (std::size_t last = 0; last < heights.size(); ++last) {
    const float width = 2.0F * scene.samples[heights[last].second].gate;
    while (heights[last].first - heights[first].first > width) ++first;
    if (last - first + 1 <= best_size) continue;
    best_size = last - first + 1;
    best = first + best_size / 2;
  }
  return scene.samples[heights[best].second].point.cast<double>();
}

/// Plane through the voters near the plane (`origin`, `normal`). Empty if fewer than `min_votes`
/// remain within the noise of it.
std::optional<PlaneHypothesis> fitVoters(const Scene& scene, const Voters& voters,
                                         const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& normal, int min_votes) {
  Plane plane = Plane::fromPointNormal(origin, normal);
  Eigen::Vector3d anchor = origin;
  int votes = 0;
  // The first plane's normal is only as good as the normals, so its gate is wider.
  for (const double widening : {3.0, 1.0, 1.0}) {
    LocalPlaneFit fit(plane.normal(), anchor);
    double slope_information = 0.0;
    for (const std::uint32_t j : voters) {
      const Eigen::Vector3d x = scene.samples[j].point.cast<double>();
      const auto gate = static_cast<double>(scene.samples[j].gate);
      if (std::abs(plane.signedDistance(x)) > widening * gate) continue;
      fit.add(x, 1.0 / (gate * gate));
      slope_information = 1.0;  // one vote's normal: slope of 1 rad per gate² weight
    }
    votes = fit.count();
    if (votes < min_votes) return std::nullopt;
    plane = fit.plane(slope_information);
    anchor = plane.project(fit.mean());
  }
  if (plane.signedDistance(scene.viewpoint) < 0.0) plane = plane.flipped();
  return PlaneHypothesis{plane, anchor, static_cast<double>(votes)};
}

/// All hypotheses of one reference point.
void detectAt(const Scene& scene, std::uint32_t r, Workspace& work, OppHypotheses& found) {
  const auto pairs = static_cast<std::size_t>(castVotes(scene, r, work));
  const int min_coplanar = scene.thresholds.coplanar[pairs];
  if (static_cast<int>(work.coplanar.size()) < min_coplanar) return;
  const Sample& sample = scene.samples[r];
  const Eigen::Vector3d x = sample.point.cast<double>(), n = sample.normal.cast<double>();
  const auto reference =
      fitVoters(scene, work.coplanar, x, meanNormal(scene, work.coplanar, n), min_coplanar);
  if (!reference) return;
  const int index = static_cast<int>(found.planes.size());
  found.planes.push_back(*reference);
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(n);
  for (;;) {
    const int min_votes = scene.thresholds.orthogonal[work.table.votes()];
    const VotePeak peak = work.table.takePeak();
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

}  // namespace

OppHypotheses detectOpps(const OrientedCloud& cloud, const SensorModel& sensor,
                         const VotingParams& params, int threads) {
  validate(params);
  if (cloud.size() < 3 || !(cloud.spacing > 0.0)) return {};
  const Scene scene = makeScene(cloud, sensor, params);
  const std::size_t count =
      std::min(cloud.size(), static_cast<std::size_t>(params.reference_points));
  constexpr std::size_t kBlock = 32;  // reference points per task; results do not depend on it
  std::vector<OppHypotheses> parts((count + kBlock - 1) / kBlock);
  parallelFor(parts.size(), threads, [&](std::size_t block) {
    Workspace work{VoteTable(params.theta_bins, params.rho_bins, scene.radius), {}, {}};
    for (std::size_t k = block * kBlock; k < std::min(count, (block + 1) * kBlock); ++k) {
      // The grid's order runs cell by cell: equal steps through it are even in space.
      const auto r = static_cast<std::uint32_t>((2 * k + 1) * cloud.size() / (2 * count));
      detectAt(scene, r, work, parts[block]);
    }
  });
  OppHypotheses all;
  for (const OppHypotheses& part : parts) append(part, all);
  return all;
}

}  // namespace opp
