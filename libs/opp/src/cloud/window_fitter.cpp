// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/window_fitter.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// One number of each window's sums.
template <typename Windows>
Lanes lanesOf(const Windows& windows, Eigen::Index value) {
  Lanes lanes;
  for (int k = 0; k < kLanes; ++k) lanes[k] = windows[static_cast<std::size_t>(k)].values[value];
  return lanes;
}

}  // namespace

WindowFitter::WindowFitter(const Patches& patches, PatchWindows& windows,
                           const Eigen::Vector3d& viewpoint, const SensorModel& sensor,
                           const SamplingParams& params)
    : patches_(patches),
      windows_(windows),
      viewpoint_(viewpoint),
      sensor_(sensor),
      params_(params),
      noise_(sensor, params, patches.pixel_angle),
      least_cosine_(std::cos(params.max_incidence)) {}

void WindowFitter::fit(const std::vector<int>& patches, int radius, std::vector<WindowFit>& fits) {
  Batch batch;
  for (const int patch : patches) {
    const auto slot = static_cast<std::size_t>(batch.size);
    batch.windows[slot] = windows_.sums(patch, radius);
    batch.patches[slot] = patch;
    WindowFit& fit = fits[static_cast<std::size_t>(patch)];
    fit = WindowFit();
    fit.freedom = batch.windows[slot].patches - kPlaneParameters;
    if (fit.freedom < 1) continue;
    if (++batch.size < kLanes) continue;
    fitBatch(batch, radius, fits);
    batch.size = 0;
  }
  if (batch.size == 0) return;
  for (auto k = static_cast<std::size_t>(batch.size); k < kLanes; ++k) {
    batch.windows[k] = batch.windows[0];
  }
  fitBatch(batch, radius, fits);
}

void WindowFitter::fitBatch(const Batch& batch, int radius, std::vector<WindowFit>& fits) {
  const auto& windows = batch.windows;
  const Lanes inverse = 1.0 / lanesOf(windows, 0);
  const VectorLanes mean{lanesOf(windows, 1) * inverse, lanesOf(windows, 2) * inverse,
                         lanesOf(windows, 3) * inverse};
  const SymmetricLanes covariance{lanesOf(windows, 4) * inverse - mean.x * mean.x,
                                  lanesOf(windows, 5) * inverse - mean.x * mean.y,
                                  lanesOf(windows, 6) * inverse - mean.x * mean.z,
                                  lanesOf(windows, 7) * inverse - mean.y * mean.y,
                                  lanesOf(windows, 8) * inverse - mean.y * mean.z,
                                  lanesOf(windows, 9) * inverse - mean.z * mean.z};
  const VectorLanes ray =
      normalized({viewpoint_.x() - mean.x, viewpoint_.y() - mean.y, viewpoint_.z() - mean.z});
  Lanes along;
  for (int k = 0; k < kLanes; ++k) along[k] = sensor_.sigma((viewpoint_ - mean[k]).norm());
  const NoisyPlanes planes = fitNoisyPlanes(covariance, ray, along, sensor_.noise_constant);
  for (int k = 0; k < batch.size; ++k) {
    const int patch = batch.patches[static_cast<std::size_t>(k)];
    WindowFit& fit = fits[static_cast<std::size_t>(patch)];
    fit.mean = mean[k];
    judge(windows[static_cast<std::size_t>(k)], patch, radius, planes[k], fit);
  }
}

void WindowFitter::judge(const WindowSums& window, int patch, int radius, const NoisyPlane& plane,
                         WindowFit& fit) {
  if (!(plane.width > 0.0) || !plane.normal.allFinite()) return;
  const Eigen::Vector3d to_viewpoint = viewpoint_ - fit.mean;
  const double range = to_viewpoint.norm();
  const double cos_incidence = plane.normal.dot(to_viewpoint) / range;
  if (!(std::abs(cos_incidence) >= least_cosine_)) return;
  // Rays that spread in two directions meet a line of points only where it hides in one of them.
  if (!window.complete && hangsOnOnePatch(patch, radius, fit.mean, narrowDirection(plane))) return;

  fit.normal = cos_incidence < 0.0 ? Eigen::Vector3d(-plane.normal) : plane.normal;
  setVariances(fit, range, std::abs(cos_incidence));
  const double count = window.values[0];
  // A surface whose normal turns by ±normal_error over the window's width w = √(12 variance)
  // deviates from its plane by normal_error·w/√180 (rms of a parabola).
  fit.bend_variance = params_.normal_error * params_.normal_error * plane.width / 15.0;
  const Eigen::Matrix3d between =
      symmetric(window.values.tail<6>()) - count * fit.mean * fit.mean.transpose();
  fit.between = std::max(0.0, fit.normal.dot(between * fit.normal));
  const double noise = fit.variance;
  // Upper quantile of χ² by its normal approximation.
  const double deviation = std::sqrt(2.0 * fit.freedom);
  fit.misfit =
      fit.between / (noise * (fit.freedom + params_.gate * deviation) + count * fit.bend_variance);
  fit.surprise = (fit.between / noise - fit.freedom) / deviation;
  fit.least_angle_variance = noise / (count * plane.width);
  fit.angle_variance = std::max(noise, fit.between / fit.freedom) / (count * plane.width);
}

void WindowFitter::setVariances(WindowFit& window, double range, double cos_incidence) const {
  const double squared_range = range * range, height = range * cos_incidence;
  window.model_variance = noise_.model(squared_range, height);
  window.expected_variance = noise_.expected(squared_range, height);
  const double least = params_.noise_floor * params_.noise_floor * window.model_variance +
                       roundingVariance(window.mean + patches_.origin);
  window.variance = std::max(least, scales_.between * window.expected_variance);
  window.spread_variance = std::max(least, scales_.within * window.expected_variance);
}

bool WindowFitter::hangsOnOnePatch(int patch, int radius, const Eigen::Vector3d& mean,
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

double WindowFitter::spreadOf(int patch, const Eigen::Vector3d& normal) const {
  const auto k = static_cast<std::size_t>(patch);
  const MomentSums& s = patches_.sums[k];
  const double x = normal.x(), y = normal.y(), z = normal.z();
  const double square =
      x * (x * s[4] + 2.0 * (y * s[5] + z * s[6])) + y * (y * s[7] + 2.0 * z * s[8]) + z * z * s[9];
  const double mean = normal.dot(patches_.means[k]);
  return square / s[0] - mean * mean;
}

}  // namespace opp
