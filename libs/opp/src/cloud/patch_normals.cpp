// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/patch_normals.h"

#include "opp/geometry/median.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace opp {
namespace {

/// The median of ratios of a measured to an expected variance, at most 3²: more noise than three
/// times the model's is taken for structure. 1 if there are none.
double scaleFrom(std::vector<double> variance_ratios) {
  constexpr double kLargest = 9.0;
  if (variance_ratios.empty()) return 1.0;
  return std::min(kLargest, medianOf(std::move(variance_ratios)));
}

}  // namespace

PatchNormals::PatchNormals(const Patches& patches, PatchWindows& windows,
                           const Eigen::Vector3d& viewpoint, const SensorModel& sensor,
                           const SamplingParams& params)
    : patches_(patches),
      windows_(windows),
      viewpoint_(viewpoint - patches.origin),
      params_(params),
      fitter_(patches, windows, viewpoint_, sensor, params),
      fits_(patches.size()),
      fit_radius_(patches.size(), 0) {}

std::vector<PatchNormal> PatchNormals::estimate() {
  std::vector<PatchNormal> result(patches_.size());
  scales_ = measureNoise();
  fitter_.setNoise(scales_);
  // Patches by the radius of the window they wait for.
  std::vector<std::vector<int>> waiting(static_cast<std::size_t>(params_.max_window_radius) + 1);
  waiting[1].resize(patches_.size());
  std::iota(waiting[1].begin(), waiting[1].end(), 0);
  for (int radius = 1; radius <= params_.max_window_radius; ++radius) {
    const std::vector<int>& now = waiting[static_cast<std::size_t>(radius)];
    prepare(now, radius);
    for (const int patch : now) {
      const int next = choose(patch, radius, result[static_cast<std::size_t>(patch)]);
      if (next > radius && next <= params_.max_window_radius) {
        waiting[static_cast<std::size_t>(next)].push_back(patch);
      }
    }
  }
  return result;
}

NoiseScales PatchNormals::measureNoise() {
  constexpr std::size_t kSamples = 1000;
  std::vector<int> samples;
  const std::size_t stride = std::max<std::size_t>(1, patches_.size() / kSamples);
  for (std::size_t i = 0; i < patches_.size(); i += stride) samples.push_back(static_cast<int>(i));
  fitter_.fit(samples, 1, fits_);
  std::vector<double> between;
  std::vector<double> within;
  for (const int i : samples) {
    const WindowFit& plane = fits_[static_cast<std::size_t>(i)];
    if (plane.normal.isZero()) continue;
    const double expected = plane.expected_variance;
    // Median of χ² over its degrees of freedom (Wilson & Hilferty 1931).
    const double median_over_mean = std::pow(1.0 - 2.0 / (9.0 * plane.freedom), 3);
    between.push_back(plane.between / (plane.freedom * median_over_mean * expected));
    const double count = patches_.sums[static_cast<std::size_t>(i)][0];
    if (count < 2.0) continue;
    within.push_back(fitter_.spreadOf(i, plane.normal) * count / (count - 1.0) / expected);
  }
  return {scaleFrom(std::move(between)), scaleFrom(std::move(within))};
}

double PatchNormals::noiseCorrelation() const {
  double points = 0.0;
  for (const MomentSums& sums : patches_.sums) points += sums[0];
  const double others =
      points / static_cast<double>(std::max<std::size_t>(1, patches_.size())) - 1.0;
  return others > 0.0 ? std::max(0.0, (scales_.between - 1.0) / others) : -1.0;
}

void PatchNormals::prepare(const std::vector<int>& patches, int radius) {
  missing_.clear();
  for (const int patch : patches) {
    int& fitted = fit_radius_[static_cast<std::size_t>(patch)];
    if (fitted != radius) missing_.push_back(patch);
    fitted = radius;
  }
  fitter_.fit(missing_, radius, fits_);
}

bool PatchNormals::fits(int patch, const WindowFit& plane) const {
  const auto k = static_cast<std::size_t>(patch);
  const double gate = params_.gate * params_.gate;
  const double count = patches_.sums[k][0];
  // In the middle of its window a parabola is √5/2 times its rms away from the plane.
  const double bend = 1.25 * plane.bend_variance;
  const double offset = plane.normal.dot(patches_.means[k] - plane.mean);
  if (offset * offset > gate * plane.variance / count + bend) return false;
  return fitter_.spreadOf(patch, plane.normal) <= gate * plane.spread_variance + bend;
}

const WindowFit* PatchNormals::bestWindow(int patch, int radius) {
  // A plain surface, which is most of a scan, needs no look at the shifted windows.
  const WindowFit& own = fits_[static_cast<std::size_t>(patch)];
  if (own.flat() && own.surprise < 1.0 && fits(patch, own)) return &own;
  windows_.shifted(patch, radius, candidates_);
  prepare(candidates_, radius);
  const WindowFit* best = nullptr;
  for (const int center : candidates_) {
    const WindowFit& candidate = fits_[static_cast<std::size_t>(center)];
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
  result = {away ? Eigen::Vector3d(-best->normal) : best->normal,
            std::sqrt(best->expected_variance)};
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
