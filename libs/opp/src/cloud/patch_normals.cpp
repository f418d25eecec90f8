// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/patch_normals.h"

#include "cloud/noisy_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace opp {
namespace {

/// A plane takes three numbers from its window; what is left measures the misfit.
constexpr int kPlaneParameters = 3;

Eigen::Matrix3d covarianceOf(const MomentSums& sums, const Eigen::Vector3d& mean) {
  Eigen::Matrix3d second;
  second << sums[4], sums[5], sums[6], sums[5], sums[7], sums[8], sums[6], sums[8], sums[9];
  return second / sums[0] - mean * mean.transpose();
}

/// Standard deviation of a coordinate that was rounded to single precision, near `point`.
double roundingSigma(const Eigen::Vector3d& point) {
  return static_cast<double>(std::numeric_limits<float>::epsilon()) *
         point.lpNorm<Eigen::Infinity>();
}

/// The median of ratios of a measured to an expected variance as a factor of standard deviations,
/// at most 3: more noise than three times the model's is taken for structure. 1 if there are none.
double scaleFrom(std::vector<double>& variance_ratios) {
  constexpr double kLargest = 3.0;
  if (variance_ratios.empty()) return 1.0;
  const auto middle =
      variance_ratios.begin() + static_cast<std::ptrdiff_t>(variance_ratios.size() / 2);
  std::nth_element(variance_ratios.begin(), middle, variance_ratios.end());
  return std::min(kLargest, std::sqrt(*middle));
}

}  // namespace

PatchNormals::PatchNormals(const Patches& patches, Neighborhood neighborhood,
                           const Eigen::Vector3d& viewpoint, const SensorModel& sensor,
                           const SamplingParams& params)
    : patches_(patches),
      neighborhood_(std::move(neighborhood)),
      viewpoint_(viewpoint - patches.origin),
      sensor_(sensor),
      params_(params),
      fits_(patches.size()),
      fit_radius_(patches.size(), 0) {}

std::vector<PatchNormal> PatchNormals::estimate() {
  std::vector<PatchNormal> result(patches_.size());
  measureNoise();
  // Patches by the radius of the window they wait for.
  std::vector<std::vector<int>> waiting(static_cast<std::size_t>(params_.max_window_radius) + 1);
  waiting[1].resize(patches_.size());
  std::iota(waiting[1].begin(), waiting[1].end(), 0);
  for (int radius = 1; radius <= params_.max_window_radius; ++radius) {
    for (const int patch : waiting[static_cast<std::size_t>(radius)]) {
      const int next = choose(patch, radius, result[static_cast<std::size_t>(patch)]);
      if (next > radius && next <= params_.max_window_radius) {
        waiting[static_cast<std::size_t>(next)].push_back(patch);
      }
    }
  }
  return result;
}

void PatchNormals::measureNoise() {
  constexpr std::size_t kSamples = 1000;
  std::vector<double> between;
  std::vector<double> within;
  const std::size_t stride = std::max<std::size_t>(1, patches_.size() / kSamples);
  for (std::size_t i = 0; i < patches_.size(); i += stride) {
    neighborhood_(static_cast<int>(i), 1, window_);
    const WindowFit plane = fitWindow(window_);
    if (plane.normal.isZero()) continue;
    const double expected = plane.expected_sigma * plane.expected_sigma;
    const int freedom = static_cast<int>(window_.size()) - kPlaneParameters;
    // Median of χ² over its degrees of freedom (Wilson & Hilferty 1931).
    const double median_over_mean = std::pow(1.0 - 2.0 / (9.0 * freedom), 3);
    between.push_back(betweenPatches(window_, plane) / (freedom * median_over_mean * expected));
    const double count = patches_.sums[i][0];
    if (count < 2.0) continue;
    within.push_back(spreadOf(static_cast<int>(i), plane.normal) * count / (count - 1.0) /
                     expected);
  }
  noise_scale_ = scaleFrom(between);
  spread_scale_ = scaleFrom(within);
}

double PatchNormals::spreadOf(int patch, const Eigen::Vector3d& normal) const {
  const auto k = static_cast<std::size_t>(patch);
  const MomentSums& s = patches_.sums[k];
  const double x = normal.x(), y = normal.y(), z = normal.z();
  const double square =
      x * (x * s[4] + 2.0 * (y * s[5] + z * s[6])) + y * (y * s[7] + 2.0 * z * s[8]) + z * z * s[9];
  const double mean = normal.dot(patches_.means[k]);
  return square / s[0] - mean * mean;
}

WindowFit PatchNormals::fitWindow(const std::vector<int>& window) const {
  WindowFit fit;
  const int freedom = static_cast<int>(window.size()) - kPlaneParameters;
  if (freedom < 1) return fit;
  MomentSums sums = MomentSums::Zero();
  for (const int i : window) sums += patches_.sums[static_cast<std::size_t>(i)];
  fit.mean = sums.segment<3>(1) / sums[0];
  const Eigen::Matrix3d covariance = covarianceOf(sums, fit.mean);
  const Eigen::Vector3d to_viewpoint = viewpoint_ - fit.mean;
  const double range = to_viewpoint.norm();
  const Eigen::Vector3d ray =
      range > 0.0 ? Eigen::Vector3d(to_viewpoint / range) : Eigen::Vector3d::UnitZ();
  const NoisyPlane plane =
      fitNoisyPlane(covariance, ray, sensor_.sigma(range), sensor_.noise_constant);
  if (!(plane.width > 0.0) || !plane.normal.allFinite()) return fit;
  if (hangsOnOnePatch(window, fit.mean, plane.narrow)) return fit;

  const double cos_incidence = plane.normal.dot(ray);
  if (std::abs(cos_incidence) < std::cos(params_.max_incidence)) return fit;
  fit.normal = cos_incidence < 0.0 ? Eigen::Vector3d(-plane.normal) : plane.normal;
  setNoise(fit, range, std::abs(cos_incidence));
  // A surface whose normal turns by ±normal_error over the window's width w = √(12 variance)
  // deviates from its plane by normal_error·w/√180 (rms of a parabola).
  fit.bend = params_.normal_error * std::sqrt(plane.width / 15.0);
  const double between = betweenPatches(window, fit);
  const double noise = fit.sigma * fit.sigma;
  // Upper quantile of χ² by its normal approximation.
  const double deviation = std::sqrt(2.0 * freedom);
  fit.misfit =
      between / (noise * (freedom + params_.gate * deviation) + sums[0] * fit.bend * fit.bend);
  fit.surprise = (between / noise - freedom) / deviation;
  fit.angle_variance = std::max(noise, between / freedom) / (sums[0] * plane.width);
  return fit;
}

void PatchNormals::setNoise(WindowFit& window, double range, double cos_incidence) const {
  window.model_sigma = sensor_.sigmaAlongNormal(range, cos_incidence);
  // A ray that is off by an angle meets a slanted surface nearer or farther (modelled so by Handa
  // et al., ICRA 2014).
  const double lateral = params_.lateral_noise * patches_.pixel_angle * range *
                         std::sqrt(std::max(0.0, 1.0 - cos_incidence * cos_incidence));
  window.expected_sigma = std::sqrt(window.model_sigma * window.model_sigma + lateral * lateral);
  const double least =
      params_.noise_floor * window.model_sigma + roundingSigma(window.mean + patches_.origin);
  window.sigma = std::max(least, noise_scale_ * window.expected_sigma);
  window.spread_sigma = std::max(least, spread_scale_ * window.expected_sigma);
}

bool PatchNormals::hangsOnOnePatch(const std::vector<int>& window, const Eigen::Vector3d& mean,
                                   const Eigen::Vector3d& narrow) const {
  double sum = 0.0;
  double largest = 0.0;
  for (const int i : window) {
    const auto k = static_cast<std::size_t>(i);
    const double lever = narrow.dot(patches_.means[k] - mean);
    const double moment = patches_.sums[k][0] * lever * lever;
    sum += moment;
    largest = std::max(largest, moment);
  }
  return 2.0 * largest > sum;
}

double PatchNormals::betweenPatches(const std::vector<int>& window, const WindowFit& plane) const {
  double sum = 0.0;
  for (const int i : window) {
    const auto k = static_cast<std::size_t>(i);
    const double offset = plane.normal.dot(patches_.means[k] - plane.mean);
    sum += patches_.sums[k][0] * offset * offset;
  }
  return sum;
}

const WindowFit& PatchNormals::fit(int patch, int radius) {
  const auto k = static_cast<std::size_t>(patch);
  if (fit_radius_[k] != radius) {
    neighborhood_(patch, radius, window_);
    fits_[k] = fitWindow(window_);
    fit_radius_[k] = radius;
  }
  return fits_[k];
}

bool PatchNormals::fits(int patch, const WindowFit& plane) const {
  const auto k = static_cast<std::size_t>(patch);
  const double gate = params_.gate * params_.gate;
  const double count = patches_.sums[k][0];
  // In the middle of its window a parabola is √5/2 times its rms away from the plane.
  const double bend = 1.25 * plane.bend * plane.bend;
  const double offset = plane.normal.dot(patches_.means[k] - plane.mean);
  if (offset * offset > gate * plane.sigma * plane.sigma / count + bend) return false;
  return spreadOf(patch, plane.normal) <= gate * plane.spread_sigma * plane.spread_sigma + bend;
}

const WindowFit* PatchNormals::bestWindow(int patch, int radius) {
  // A plain surface, which is most of a scan, needs no look at the shifted windows.
  const WindowFit& own = fit(patch, radius);
  if (own.flat() && own.surprise < 1.0 && fits(patch, own)) return &own;
  // Fitting the other windows overwrites `window_`, so the candidates are kept apart.
  neighborhood_(patch, radius, candidates_);
  const WindowFit* best = nullptr;
  for (const int center : candidates_) {
    const WindowFit& candidate = fit(center, radius);
    if (!candidate.flat() || (best != nullptr && candidate.misfit >= best->misfit)) continue;
    if (fits(patch, candidate)) best = &candidate;
  }
  return best;
}

/// Writes the normal and returns 0, or returns the radius at which to try again; 0 also if none
/// will do.
int PatchNormals::choose(int patch, int radius, PatchNormal& result) {
  const WindowFit* best = bestWindow(patch, radius);
  const double tolerance = params_.normal_error * params_.normal_error;
  if (best == nullptr) {
    const WindowFit& own = fits_[static_cast<std::size_t>(patch)];
    return own.found() && own.angle_variance <= tolerance ? 0 : radius + 1;
  }
  if (best->angle_variance > tolerance) return sufficientRadius(*best, radius);
  const Eigen::Vector3d to_viewpoint = viewpoint_ - patches_.means[static_cast<std::size_t>(patch)];
  const bool away = best->normal.dot(to_viewpoint) < 0.0;
  result = {away ? Eigen::Vector3d(-best->normal) : best->normal, best->model_sigma};
  return 0;
}

/// The variance of a normal goes with the fourth power of its window's width: points and lever
/// grow.
int PatchNormals::sufficientRadius(const WindowFit& window, int radius) const {
  const double tolerance = params_.normal_error * params_.normal_error;
  const double growth = std::sqrt(std::sqrt(window.angle_variance / tolerance));
  const double needed = 0.5 * (growth * (2 * radius + 1) - 1.0);
  const double limit = params_.max_window_radius + 1;
  return std::max(radius + 1, static_cast<int>(std::ceil(std::min(limit, needed))));
}

}  // namespace opp
