// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/patch_normals.h"

#include <Eigen/Eigenvalues>

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

/// Unit normal and smaller tangential variance of points with covariance `covariance`, whose noise
/// is `along` in the direction of the unit vector `ray` and `across` in the others. The normal n
/// minimizes nᵀCn / nᵀΣn, Σ the noise's covariance. Plain least squares (Σ = I) would turn slanted
/// surfaces toward the sensor by several degrees, because noise along the ray spreads the points
/// in the plane as well.
struct NoisyPlane {
  Eigen::Vector3d normal;
  Eigen::Vector3d narrow;  ///< unit tangent along which the points extend less
  double width;            ///< their variance along it, without the noise [m²]
};

NoisyPlane fitNoisyPlane(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& ray,
                         double along, double across) {
  const double squeeze = across / along;
  const Eigen::Matrix3d whiten =
      Eigen::Matrix3d::Identity() - (1.0 - squeeze) * ray * ray.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(whiten * covariance * whiten);
  const double least = std::max(0.0, eigen.eigenvalues()[0]);
  const Eigen::Vector3d normal = (whiten * eigen.eigenvectors().col(0)).normalized();
  // C − λΣ has the normal in its kernel; its other eigenvalues are the widths of the surface.
  const double stretch = 1.0 / (squeeze * squeeze) - 1.0;
  const Eigen::Matrix3d surface =
      covariance - least * (Eigen::Matrix3d::Identity() + stretch * ray * ray.transpose());
  const double sum = surface.trace();
  const double product = surface(0, 0) * surface(1, 1) - surface(0, 1) * surface(0, 1) +
                         surface(0, 0) * surface(2, 2) - surface(0, 2) * surface(0, 2) +
                         surface(1, 1) * surface(2, 2) - surface(1, 2) * surface(1, 2);
  const double larger = 0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4.0 * product)));
  const double smaller = larger > 0.0 ? product / larger : 0.0;
  // What is left without the narrow part is the wide direction times its transpose.
  const Eigen::Matrix3d wide =
      surface - smaller * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
  Eigen::Index column = 0;
  wide.diagonal().maxCoeff(&column);
  return {normal, normal.cross(wide.col(column)).normalized(), smaller};
}

/// The median of ratios of a measured to an expected variance as a factor of standard deviations,
/// at most 2: more noise than twice the model's is taken for structure. 1 if there are none.
double scaleFrom(std::vector<double>& variance_ratios) {
  constexpr double kLargest = 2.0;
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
  std::vector<int> pending(patches_.size());
  std::iota(pending.begin(), pending.end(), 0);
  std::vector<int> uncertain;
  for (int radius = 1; radius <= params_.max_window_radius && !pending.empty(); ++radius) {
    uncertain.clear();
    for (const int patch : pending) {
      if (choose(patch, radius, result[static_cast<std::size_t>(patch)]) == Verdict::kUncertain) {
        uncertain.push_back(patch);
      }
    }
    pending.swap(uncertain);
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
    const double expected = plane.model_sigma * plane.model_sigma;
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
  return normal.dot(covarianceOf(patches_.sums[k], patches_.means[k]) * normal);
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
  fit.model_sigma = sensor_.sigmaAlongNormal(range, cos_incidence);
  const double rounding = roundingSigma(fit.mean + patches_.origin);
  fit.sigma = std::hypot(noise_scale_ * fit.model_sigma, rounding);
  fit.spread_sigma = std::hypot(spread_scale_ * fit.model_sigma, rounding);
  // A surface whose normal turns by ±normal_error over the window's width w = √(12 variance)
  // deviates from its plane by normal_error·w/√180 (rms of a parabola).
  fit.bend = params_.normal_error * std::sqrt(plane.width / 15.0);
  const double between = betweenPatches(window, fit);
  const double noise = fit.sigma * fit.sigma;
  // Upper quantile of χ² by its normal approximation.
  const double quantile = freedom + params_.gate * std::sqrt(2.0 * freedom);
  fit.misfit = between / (noise * quantile + sums[0] * fit.bend * fit.bend);
  fit.angle_variance = std::max(noise, between / freedom) / (sums[0] * plane.width);
  return fit;
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

PatchNormals::Verdict PatchNormals::choose(int patch, int radius, PatchNormal& result) {
  // Fitting the other windows overwrites `window_`, so the candidates are kept apart.
  neighborhood_(patch, radius, candidates_);
  const WindowFit* best = nullptr;
  for (const int center : candidates_) {
    const WindowFit& candidate = fit(center, radius);
    if (!candidate.flat() || !fits(patch, candidate)) continue;
    if (best == nullptr || candidate.misfit < best->misfit) best = &candidate;
  }
  const WindowFit& own = fits_[static_cast<std::size_t>(patch)];
  const double tolerance = params_.normal_error * params_.normal_error;
  if (best == nullptr) {
    return own.angle_variance <= tolerance && !own.normal.isZero() ? Verdict::kEdge
                                                                   : Verdict::kUncertain;
  }
  if (best->angle_variance > tolerance) return Verdict::kUncertain;
  const Eigen::Vector3d to_viewpoint = viewpoint_ - patches_.means[static_cast<std::size_t>(patch)];
  const bool away = best->normal.dot(to_viewpoint) < 0.0;
  result = {away ? Eigen::Vector3d(-best->normal) : best->normal, best->model_sigma};
  return Verdict::kFound;
}

}  // namespace opp
