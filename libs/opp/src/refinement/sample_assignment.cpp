// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/sample_assignment.h"

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

struct Match {
  std::size_t plane = 0;
  double distance = std::numeric_limits<double>::infinity();  ///< signed, along the group's normal
};

/// Updates `best` with the plane of a group that is nearest to a point at `position` along the
/// group's normal.
void takeNearest(const ParallelGroup& group, const Eigen::Vector3d& point,
                 const std::vector<PlaneFit>& fits, Match& best) {
  const double position = group.normal.dot(point);
  for (const ParallelGroup::Member& member : group.members) {
    const double distance = position - member.position;
    if (std::abs(distance) < std::abs(best.distance) && fits[member.plane].reach.contains(point)) {
      best = {member.plane, distance};
    }
  }
}

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
    sample.variance = kLeastVariance + rounding * rounding + sigma * sigma;
  }
  return samples;
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
}

bool SampleSums::add(const WeightedSample& sample, double distance, double slack,
                     double outlier_cutoff) {
  const double precision = 1.0 / (sample.variance + slack * slack);
  const double square = distance * distance;
  const double root = 1.0 - square * precision / (outlier_cutoff * outlier_cutoff);
  if (!(root > 0.0)) return false;
  const double robust = root * root;
  const Eigen::Vector3d x = sample.point - origin;
  const Eigen::Vector3d wx = robust * precision * x;
  weight += robust * precision;
  first += wx;
  second.col(0) += wx * x[0];
  second.col(1).tail<2>() += wx.tail<2>() * x[1];
  second(2, 2) += wx[2] * x[2];
  robust_weight += robust;
  square_sum += robust * square;
  variance_sum += robust * sample.variance;
  area += sample.area;
  ++support;
  return true;
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
  const double squared_extent = sums.area / sums.support;
  Eigen::Vector2d known;
  for (int k = 0; k < 2; ++k) {
    const double points = std::max(0.0, axes.eigenvalues()[k]);
    // w² = 12 variances.
    const double rim = points > 0.0 ? squared_extent * moments.weight() / (16.0 * points) : 1.0;
    known[k] = points / (1.0 + points * rim * rim);
  }
  const Eigen::Matrix<double, 3, 2> directions = tangents * axes.eigenvectors();
  return directions * known.asDiagonal() * directions.transpose();
}

ParallelGroup makeGroup(const Eigen::Vector3d& normal, const std::vector<std::size_t>& planes,
                        const std::vector<PlaneFit>& fits) {
  ParallelGroup group{normal, {}};
  for (const std::size_t index : planes) {
    const Plane& plane = fits[index].plane;
    const double sign = plane.normal().dot(normal) < 0.0 ? -1.0 : 1.0;
    group.members.push_back({-sign * plane.d(), index});
  }
  std::stable_sort(group.members.begin(), group.members.end(),
                   [](const auto& a, const auto& b) { return a.position < b.position; });
  return group;
}

void assignSamples(const std::vector<WeightedSample>& samples,
                   const std::vector<ParallelGroup>& groups, const RefinementParams& params,
                   std::size_t stride, std::vector<PlaneFit>& fits, std::vector<int>& labels) {
  if (fits.empty()) return;
  for (PlaneFit& fit : fits) {
    SampleSums cleared;
    cleared.origin = fit.moments.empty() ? fit.plane.project(cleared.origin) : fit.moments.mean();
    fit.sums = cleared;
  }
  const double least_cosine = std::cos(params.normal_gate);
  for (std::size_t i = 0; i < samples.size(); i += stride) {
    const WeightedSample& sample = samples[i];
    const double explained = kExplainedSigmas * std::sqrt(sample.variance);
    Match best;
    for (const ParallelGroup& group : groups) {
      if (!(std::abs(group.normal.dot(sample.normal)) >= least_cosine)) continue;
      takeNearest(group, sample.point, fits, best);
      if (std::abs(best.distance) < explained) break;
    }
    PlaneFit& fit = fits[best.plane];
    const bool matched = std::isfinite(best.distance) &&
                         fit.sums.add(sample, best.distance, fit.slack, params.outlier_cutoff);
    labels[i] = matched ? static_cast<int>(best.plane) : -1;
  }
  for (PlaneFit& fit : fits) fit.moments = fit.sums.moments();
}

}  // namespace opp
