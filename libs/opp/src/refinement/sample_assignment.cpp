// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/sample_assignment.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp {
namespace {

/// Misfit of a plane counts if noise alone would not produce it in 19 of 20 planes.
constexpr double kChanceSigmas = 2.0;

/// Worth of the mean of n equally correlated measurements, in independent ones.
double effectiveCount(double n, double correlation) { return n / (1.0 + (n - 1.0) * correlation); }

struct Match {
  std::size_t plane = 0;
  double distance = std::numeric_limits<double>::infinity();  ///< signed, along the group's normal
};

/// Nearest plane of a group to a point at `position` along its normal.
Match nearest(const ParallelGroup& group, double position) {
  const auto above = std::lower_bound(
      group.members.begin(), group.members.end(), position,
      [](const ParallelGroup::Member& member, double x) { return member.position < x; });
  Match match;
  if (above != group.members.end()) match = {above->plane, position - above->position};
  if (above != group.members.begin()) {
    const ParallelGroup::Member& below = *std::prev(above);
    const double distance = position - below.position;
    if (distance < std::abs(match.distance)) match = {below.plane, distance};
  }
  return match;
}

Match nearestWithNormal(const std::vector<ParallelGroup>& groups, const Eigen::Vector3d& point,
                        const Eigen::Vector3d& normal, double least_cosine) {
  Match best;
  for (const ParallelGroup& group : groups) {
    if (!(std::abs(group.normal.dot(normal)) >= least_cosine)) continue;
    const Match match = nearest(group, group.normal.dot(point));
    if (std::abs(match.distance) < std::abs(best.distance)) best = match;
  }
  return best;
}

}  // namespace

double PlaneFit::excess(double outlier_cutoff) const {
  if (!(robust_weight > 0.0)) return 0.0;
  // E[ω r²] / E[ω] of a standard normal r under ω = (1 − r²/c²)².
  const double inverse = 1.0 / (outlier_cutoff * outlier_cutoff);
  const double expected = (1.0 - 6.0 * inverse + 15.0 * inverse * inverse) /
                          (1.0 - 2.0 * inverse + 3.0 * inverse * inverse);
  const double mean_square = square_sum / robust_weight / expected;
  // Mean squares of N Gaussian residuals scatter by √(2/N).
  const double chance = kChanceSigmas * std::sqrt(2.0 / support) * meanVariance();
  const double beyond = mean_square - meanVariance();
  return beyond > chance ? std::sqrt(beyond) : 0.0;
}

void PlaneFit::clearSums() {
  moments = PointMoments();
  robust_weight = square_sum = variance_sum = 0.0;
  support = 0;
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

void assignSamples(const OrientedCloud& cloud, const std::vector<ParallelGroup>& groups,
                   const RefinementParams& params, std::size_t stride, std::vector<PlaneFit>& fits,
                   std::vector<int>& labels) {
  for (PlaneFit& fit : fits) fit.clearSums();
  const double least_cosine = std::cos(params.normal_gate);
  const double cutoff_squared = params.outlier_cutoff * params.outlier_cutoff;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    labels[i] = -1;
    const Eigen::Vector3d point = cloud.points[i].cast<double>();
    const Match match =
        nearestWithNormal(groups, point, cloud.normals[i].cast<double>(), least_cosine);
    if (!std::isfinite(match.distance)) continue;
    PlaneFit& fit = fits[match.plane];
    // Coordinates are rounded to float: no distance is better known than that.
    const double rounding = std::numeric_limits<float>::epsilon() * point.norm();
    const double sigma = static_cast<double>(cloud.sigmas[i]);
    const double variance = sigma * sigma + rounding * rounding;
    const double spread = variance + fit.slack * fit.slack;
    const double square = match.distance * match.distance;
    if (!(square < cutoff_squared * spread)) continue;
    const double root = 1.0 - square / (cutoff_squared * spread);
    const double robust = root * root;
    const double count =
        effectiveCount(static_cast<double>(cloud.weights[i]), params.noise_correlation);
    fit.moments.add(point, robust * count / spread);
    fit.robust_weight += robust;
    fit.square_sum += robust * square;
    fit.variance_sum += robust * variance;
    ++fit.support;
    labels[i] = static_cast<int>(match.plane);
  }
}

}  // namespace opp
