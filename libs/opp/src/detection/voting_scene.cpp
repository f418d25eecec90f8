// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detection/voting_scene.h"

#include "opp/detection/vote_table.h"
#include "opp/geometry/constants.h"

#include <cmath>

namespace opp {

VoteThresholds::VoteThresholds(const VotingParams& params) {
  const double bins = static_cast<double>(params.theta_bins) * params.rho_bins;
  // A random normal is parallel within δ with probability 1 − cos δ; a random direction d is within
  // δ of the plane with probability sin δ.
  const double parallel =
      (1.0 - std::cos(params.normal_tolerance)) * std::sin(params.normal_tolerance);
  // Random places in a disc fall into the 3 × 3 bins about ρ = 0 with density 4/π of the average.
  const double window = 9.0 / bins * 4.0 / kPi;
  int least_coplanar = 0, least_orthogonal = 0;
  for (int pairs = 0; pairs <= params.partners; ++pairs) {
    least_coplanar = significantVotes(parallel * pairs, 1.0, params.false_alarms, least_coplanar);
    least_orthogonal =
        significantVotes(window * pairs, bins, params.false_alarms, least_orthogonal);
    coplanar.push_back(least_coplanar);
    orthogonal.push_back(least_orthogonal);
  }
}

std::vector<VotingSample> votingSamples(const OrientedCloud& cloud, std::size_t begin,
                                        const SensorModel& sensor, const VotingParams& params) {
  std::vector<VotingSample> samples;
  samples.reserve(cloud.size() - begin);
  const SensorModel shown = sensor.withCorrelation(cloud.noise_correlation);
  for (std::size_t i = begin; i < cloud.size(); ++i) {
    const double sigma = shown.meanSigma(static_cast<double>(cloud.sigmas[i]),
                                         static_cast<double>(cloud.weights[i]));
    const double gate = params.noise_gate * sigma + params.flatness * cloud.extent(i);
    samples.push_back({cloud.points[i], cloud.normals[i], static_cast<float>(gate),
                       static_cast<float>(cloud.extent(i))});
  }
  return samples;
}

namespace {

std::vector<Eigen::Vector3f> pointsOf(const std::vector<VotingSample>& samples) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(samples.size());
  for (const VotingSample& sample : samples) points.push_back(sample.point);
  return points;
}

}  // namespace

// Cells of half the radius: most of what they hold is inside the ball, and they are few.
VotingScene::VotingScene(const std::vector<VotingSample>& scene_samples,
                         const Eigen::Vector3f& scene_viewpoint, const VotingParams& voting_params,
                         double scene_radius, double scene_spacing)
    : params(voting_params),
      radius(scene_radius),
      spacing(scene_spacing),
      grid(pointsOf(scene_samples), 0.5 * radius, static_cast<std::uint64_t>(params.seed)),
      viewpoint(scene_viewpoint.cast<double>()) {
  samples.reserve(scene_samples.size());
  for (const std::uint32_t i : grid.order()) samples.push_back(scene_samples[i]);
}

}  // namespace opp
