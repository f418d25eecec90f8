// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/sample_assignment.h"

#include "opp/cloud/rim_error.h"

#include "refinement/candidates.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp {
namespace {

/// Misfit of a plane counts if noise alone would not produce it in 19 of 20 planes.
constexpr double kChanceSigmas = 2.0;
/// A sample this near to a plane needs no other explanation.
constexpr double kExplainedSigmas = 2.0;
/// (1e-9 m)²: below any sensor's noise, and no division by zero at the origin.
constexpr double kLeastVariance = 1e-18;

}  // namespace

std::vector<WeightedSample> weightedSamples(const OrientedCloud& cloud, const SensorModel& sensor) {
  const SensorModel shown = sensor.withCorrelation(cloud.noise_correlation);
  std::vector<WeightedSample> samples(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    WeightedSample& sample = samples[i];
    sample.point = cloud.points[i].cast<double>();
    sample.normal = cloud.normals[i].cast<double>();
    // Coordinates are rounded to float: no distance is better known than that.
    const double rounding = std::numeric_limits<float>::epsilon() * sample.point.norm();
    const double count = std::max(1.0, static_cast<double>(cloud.weights[i]));
    const double sigma = shown.meanSigma(static_cast<double>(cloud.sigmas[i]), count);
    sample.area = cloud.extent(i) * cloud.extent(i);
    sample.patch_area = cloud.patchExtent(i) * cloud.patchExtent(i);
    sample.variance = kLeastVariance + rounding * rounding + sigma * sigma;
  }
  return samples;
}

std::vector<std::vector<std::uint32_t>> membersOf(const std::vector<int>& labels,
                                                  std::size_t planes) {
  std::vector<std::vector<std::uint32_t>> members(planes);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] < 0) continue;
    members[static_cast<std::size_t>(labels[i])].push_back(static_cast<std::uint32_t>(i));
  }
  return members;
}

PointMoments SampleSums::moments() const {
  if (!(weight > 0.0)) return {};
  const Eigen::Vector3d mean = first / weight;
  Eigen::Matrix3d scatter = second.selfadjointView<Eigen::Lower>();
  scatter -= weight * mean * mean.transpose();
  return {weight, origin + mean, scatter};
}

void SampleSums::merge(const SampleSums& other) {
  PointMoments joint = moments();
  joint.merge(other.moments());
  origin = joint.mean();
  weight = joint.weight();
  first.setZero();
  second = joint.scatter();
  robust_weight += other.robust_weight;
  square_sum += other.square_sum;
  variance_sum += other.variance_sum;
  support += other.support;
  area += other.area;
  patch_area += other.patch_area;
}

double SampleSums::excess(double outlier_cutoff) const {
  if (!(robust_weight > 0.0)) return 0.0;
  // E[ω r²] / E[ω] of a standard normal r under ω = (1 − r²/c²)².
  const double inverse = 1.0 / (outlier_cutoff * outlier_cutoff);
  const double expected = (1.0 - 6.0 * inverse + 15.0 * inverse * inverse) /
                          (1.0 - 2.0 * inverse + 3.0 * inverse * inverse);
  const double mean_square = meanSquare() / expected;
  // Mean squares of N Gaussian residuals scatter by √(2/N).
  const double chance = kChanceSigmas * std::sqrt(2.0 / support) * meanVariance();
  const double beyond = mean_square - meanVariance();
  return beyond > chance ? std::sqrt(beyond) : 0.0;
}

Eigen::Matrix3d PlaneFit::information(const Eigen::Vector3d& normal) const {
  if (moments.empty() || sums.support == 0) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(normal);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(tangents.transpose() *
                                                            moments.scatter() * tangents);
  const double squared_extent = sums.patch_area / sums.support;
  Eigen::Vector2d known = Eigen::Vector2d::Zero();
  for (int k = 0; k < 2; ++k) {
    const double points = axes.eigenvalues()[k];
    if (!(points > 0.0)) continue;
    const double turn = rimError(squared_extent, points / moments.weight()).turn;
    known[k] = points / (1.0 + points * turn * turn);
  }
  const Eigen::Matrix<double, 3, 2> directions = tangents * axes.eigenvectors();
  return directions * known.asDiagonal() * directions.transpose();
}

namespace {

/// Planes that rest, as all their rivals do.
std::vector<std::uint8_t> frozenPlanes(const Candidates& candidates,
                                       const std::vector<PlaneFit>& fits) {
  std::vector<std::uint8_t> frozen(fits.size(), 0);
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const auto& rivals = candidates.rivals[k];
    const auto rests = [&](std::uint32_t plane) { return fits[plane].rests; };
    frozen[k] = fits[k].rests && std::all_of(rivals.begin(), rivals.end(), rests) ? 1 : 0;
  }
  return frozen;
}

struct Match {
  std::uint32_t plane = 0;
  double distance = std::numeric_limits<double>::infinity();
};

Match matchOf(const WeightedSample& sample, const Candidates::Entry* begin,
              const Candidates::Entry* end, const std::vector<Plane>& planes, double least_cosine) {
  constexpr double kExplained = kExplainedSigmas * kExplainedSigmas;
  Match best;
  std::uint32_t group = 0;
  for (const Candidates::Entry* entry = begin; entry != end; ++entry) {
    if (entry->group != group && best.distance * best.distance < kExplained * sample.variance)
      break;
    group = entry->group;
    const Plane& plane = planes[entry->plane];
    const double distance = std::abs(plane.signedDistance(sample.point));
    if (distance >= best.distance) continue;
    if (!(std::abs(plane.normal().dot(sample.normal)) >= least_cosine)) continue;
    best = {entry->plane, distance};
  }
  return best;
}

}  // namespace

void assignSamples(const std::vector<WeightedSample>& samples, const Candidates& candidates,
                   const RefinementParams& params, std::vector<PlaneFit>& fits,
                   std::vector<int>& labels) {
  const std::vector<std::uint8_t> frozen = frozenPlanes(candidates, fits);
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (frozen[k] != 0) continue;
    PlaneFit& fit = fits[k];
    SampleSums cleared;
    cleared.origin = fit.moments.empty() ? fit.plane.project(cleared.origin) : fit.moments.mean();
    fit.sums = cleared;
  }
  const double least_cosine = std::cos(params.normal_gate);
  const double weight_slope = 1.0 / (params.outlier_cutoff * params.outlier_cutoff);
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (frozen[k] != 0) continue;
    SampleSums sums = fits[k].sums;  // a copy, so that the compiler keeps it in registers
    const double squared_slack = fits[k].slack * fits[k].slack;
    const Plane plane = fits[k].plane;
    for (const std::uint32_t i : candidates.uncontested[k]) {
      const WeightedSample& sample = samples[i];
      const bool parallel = std::abs(plane.normal().dot(sample.normal)) >= least_cosine;
      const double distance = plane.signedDistance(sample.point);
      const bool added = parallel && sums.add(sample, distance, squared_slack, weight_slope);
      labels[i] = added ? static_cast<int>(k) : -1;
    }
    fits[k].sums = sums;
  }
  std::vector<Plane> planes;  // side by side: the fits together would not fit the cache
  for (const PlaneFit& fit : fits) planes.push_back(fit.plane);
  for (const std::uint32_t i : candidates.contested) {
    const Candidates::Entry* begin = candidates.entries.data() + candidates.begin[i];
    const Candidates::Entry* end = candidates.entries.data() + candidates.begin[i + 1];
    Match match;
    if (std::any_of(begin, end, [&](const auto& entry) { return frozen[entry.plane] != 0; })) {
      // All candidates rest: nothing changes.
      if (labels[i] < 0 || frozen[static_cast<std::size_t>(labels[i])] != 0) continue;
      match.plane = static_cast<std::uint32_t>(labels[i]);
      match.distance = std::abs(fits[match.plane].plane.signedDistance(samples[i].point));
    } else {
      match = matchOf(samples[i], begin, end, planes, least_cosine);
    }
    PlaneFit& fit = fits[match.plane];
    const bool matched =
        std::isfinite(match.distance) &&
        fit.sums.add(samples[i], match.distance, fit.slack * fit.slack, weight_slope);
    labels[i] = matched ? static_cast<int>(match.plane) : -1;
  }
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (frozen[k] == 0) fits[k].moments = fits[k].sums.moments();
  }
}

}  // namespace opp
