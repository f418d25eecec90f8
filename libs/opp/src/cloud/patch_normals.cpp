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

/// Symmetric matrix from xx, xy, xz, yy, yz, zz.
template <typename Values>
Eigen::Matrix3d symmetric(const Values& v) {
  Eigen::Matrix3d matrix;
  matrix << v[0], v[1], v[2], v[1], v[3], v[4], v[2], v[4], v[5];
  return matrix;
}

/// Variance of a coordinate that was rounded to single precision, near `point`.
double roundingVariance(const Eigen::Vector3d& point) {
  const double rounding =
      static_cast<double>(std::numeric_limits<float>::epsilon()) * point.lpNorm<Eigen::Infinity>();
  return rounding * rounding;
}

/// The median of ratios of a measured to an expected variance, at most 3²: more noise than three
/// times the model's is taken for structure. 1 if there are none.
double scaleFrom(std::vector<double>& variance_ratios) {
  constexpr double kLargest = 9.0;
  if (variance_ratios.empty()) return 1.0;
  const auto middle =
      variance_ratios.begin() + static_cast<std::ptrdiff_t>(variance_ratios.size() / 2);
  std::nth_element(variance_ratios.begin(), middle, variance_ratios.end());
  return std::min(kLargest, *middle);
}

}  // namespace

PatchNormals::PatchNormals(const Patches& patches, PatchWindows& windows,
                           const Eigen::Vector3d& viewpoint, const SensorModel& sensor,
                           const SamplingParams& params)
    : patches_(patches),
      windows_(windows),
      viewpoint_(viewpoint - patches.origin),
      sensor_(sensor),
      params_(params),
      least_cosine_(std::cos(params.max_incidence)),
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
    const WindowFit plane = fitWindow(static_cast<int>(i), 1);
    if (plane.normal.isZero()) continue;
    const double expected = plane.expected_variance;
    // Median of χ² over its degrees of freedom (Wilson & Hilferty 1931).
    const double median_over_mean = std::pow(1.0 - 2.0 / (9.0 * plane.freedom), 3);
    between.push_back(plane.between / (plane.freedom * median_over_mean * expected));
    const double count = patches_.sums[i][0];
    if (count < 2.0) continue;
    within.push_back(spreadOf(static_cast<int>(i), plane.normal) * count / (count - 1.0) /
                     expected);
  }
  noise_scale_ = scaleFrom(between);
  spread_scale_ = scaleFrom(within);
}

double PatchNormals::noiseCorrelation() const {
  double points = 0.0;
  for (const MomentSums& sums : patches_.sums) points += sums[0];
  const double others =
      points / static_cast<double>(std::max<std::size_t>(1, patches_.size())) - 1.0;
  return others > 0.0 ? std::max(0.0, (noise_scale_ - 1.0) / others) : -1.0;
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

WindowFit PatchNormals::fitWindow(int patch, int radius) {
  WindowFit fit;
  const WindowSums window = windows_.sums(patch, radius);
  fit.freedom = window.patches - kPlaneParameters;
  if (fit.freedom < 1) return fit;
  const double count = window.values[0];
  fit.mean = window.values.segment<3>(1) / count;
  const Eigen::Matrix3d mean_square = fit.mean * fit.mean.transpose();
  const Eigen::Matrix3d covariance = symmetric(window.values.segment<6>(4)) / count - mean_square;
  const Eigen::Vector3d to_viewpoint = viewpoint_ - fit.mean;
  const double range = to_viewpoint.norm();
  const Eigen::Vector3d ray =
      range > 0.0 ? Eigen::Vector3d(to_viewpoint / range) : Eigen::Vector3d::UnitZ();
  const NoisyPlane plane =
      fitNoisyPlane(covariance, ray, sensor_.sigma(range), sensor_.noise_constant);
  if (!(plane.width > 0.0) || !plane.normal.allFinite()) return fit;
  const double cos_incidence = plane.normal.dot(ray);
  if (std::abs(cos_incidence) < least_cosine_) return fit;
  // Rays that spread in two directions meet a line of points only where it hides in one of them.
  if (!window.complete && hangsOnOnePatch(patch, radius, fit.mean, narrowDirection(plane))) {
    return fit;
  }

  fit.normal = cos_incidence < 0.0 ? Eigen::Vector3d(-plane.normal) : plane.normal;
  setNoise(fit, range, std::abs(cos_incidence));
  // A surface whose normal turns by ±normal_error over the window's width w = √(12 variance)
  // deviates from its plane by normal_error·w/√180 (rms of a parabola).
  fit.bend_variance = params_.normal_error * params_.normal_error * plane.width / 15.0;
  const Eigen::Matrix3d between = symmetric(window.values.tail<6>()) - count * mean_square;
  fit.between = std::max(0.0, fit.normal.dot(between * fit.normal));
  const double noise = fit.variance;
  // Upper quantile of χ² by its normal approximation.
  const double deviation = std::sqrt(2.0 * fit.freedom);
  fit.misfit =
      fit.between / (noise * (fit.freedom + params_.gate * deviation) + count * fit.bend_variance);
  fit.surprise = (fit.between / noise - fit.freedom) / deviation;
  fit.least_angle_variance = noise / (count * plane.width);
  fit.angle_variance = std::max(noise, fit.between / fit.freedom) / (count * plane.width);
  return fit;
}

void PatchNormals::setNoise(WindowFit& window, double range, double cos_incidence) const {
  const double sigma = sensor_.sigmaAlongNormal(range, cos_incidence);
  window.model_variance = sigma * sigma;
  // A ray that is off by an angle meets a slanted surface nearer or farther (modelled so by Handa
  // et al., ICRA 2014).
  const double lateral = params_.lateral_noise * patches_.pixel_angle * range;
  window.expected_variance = window.model_variance +
                             lateral * lateral * std::max(0.0, 1.0 - cos_incidence * cos_incidence);
  const double least = params_.noise_floor * params_.noise_floor * window.model_variance +
                       roundingVariance(window.mean + patches_.origin);
  window.variance = std::max(least, noise_scale_ * window.expected_variance);
  window.spread_variance = std::max(least, spread_scale_ * window.expected_variance);
}

bool PatchNormals::hangsOnOnePatch(int patch, int radius, const Eigen::Vector3d& mean,
                                   const Eigen::Vector3d& narrow) {
  windows_.members(patch, radius, window_);
  double sum = 0.0;
  double largest = 0.0;
  for (const int i : window_) {
    const auto k = static_cast<std::size_t>(i);
    const double lever = narrow.dot(patches_.means[k] - mean);
    const double moment = patches_.sums[k][0] * lever * lever;
    sum += moment;
    largest = std::max(largest, moment);
  }
  return 2.0 * largest > sum;
}

const WindowFit& PatchNormals::fit(int patch, int radius) {
  const auto k = static_cast<std::size_t>(patch);
  if (fit_radius_[k] != radius) {
    fits_[k] = fitWindow(patch, radius);
    fit_radius_[k] = radius;
  }
  return fits_[k];
}

bool PatchNormals::fits(int patch, const WindowFit& plane) const {
  const auto k = static_cast<std::size_t>(patch);
  const double gate = params_.gate * params_.gate;
  const double count = patches_.sums[k][0];
  // In the middle of its window a parabola is √5/2 times its rms away from the plane.
  const double bend = 1.25 * plane.bend_variance;
  const double offset = plane.normal.dot(patches_.means[k] - plane.mean);
  if (offset * offset > gate * plane.variance / count + bend) return false;
  return spreadOf(patch, plane.normal) <= gate * plane.spread_variance + bend;
}

const WindowFit* PatchNormals::bestWindow(int patch, int radius) {
  // A plain surface, which is most of a scan, needs no look at the shifted windows.
  const WindowFit& own = fit(patch, radius);
  if (own.flat() && own.surprise < 1.0 && fits(patch, own)) return &own;
  windows_.shifted(patch, radius, candidates_);
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
    // Where noise leaves the window certain enough, structure is what bends it: a wider one has
    // more.
    return own.found() && own.least_angle_variance <= tolerance ? 0 : radius + 1;
  }
  if (best->angle_variance > tolerance) return sufficientRadius(*best, radius);
  const Eigen::Vector3d to_viewpoint = viewpoint_ - patches_.means[static_cast<std::size_t>(patch)];
  const bool away = best->normal.dot(to_viewpoint) < 0.0;
  result = {away ? Eigen::Vector3d(-best->normal) : best->normal, std::sqrt(best->model_variance)};
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
