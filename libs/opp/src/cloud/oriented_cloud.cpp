// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/cloud/oriented_cloud.h"

#include "opp/cloud/even_sampling.h"
#include "opp/geometry/median.h"

#include "cloud/check_cloud.h"
#include "cloud/grid_patches.h"
#include "cloud/patch_normals.h"
#include "cloud/voxel_patches.h"
#include "primitives/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace opp {
namespace {

bool inRange(const Eigen::Vector3f& point, const PointCloud& cloud, const SensorModel& sensor) {
  const double range = (point - cloud.viewpoint).cast<double>().norm();
  return range >= sensor.min_range && range <= sensor.max_range;
}

void reserve(OrientedCloud& cloud, std::size_t count) {
  cloud.points.reserve(count);
  cloud.normals.reserve(count);
  cloud.sigmas.reserve(count);
  cloud.weights.reserve(count);
}

void append(OrientedCloud& cloud, const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
            double sigma, double weight) {
  cloud.points.push_back(point);
  cloud.normals.push_back(normal);
  cloud.sigmas.push_back(static_cast<float>(sigma));
  cloud.weights.push_back(static_cast<float>(weight));
}

/// The points with a usable normal, turned to the viewpoint.
OrientedCloud fromGivenNormals(const PointCloud& cloud, const SensorModel& sensor) {
  OrientedCloud dense;
  reserve(dense, cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d normal = cloud.normals[i].cast<double>();
    const double length = normal.norm();
    if (!inRange(cloud.points[i], cloud, sensor) || !(length > 0.0) || !std::isfinite(length))
      continue;
    const Eigen::Vector3d to_viewpoint = (cloud.viewpoint - cloud.points[i]).cast<double>();
    const double range = to_viewpoint.norm();
    const double toward = normal.dot(to_viewpoint) / length;
    const double cos_incidence = range > 0.0 ? std::abs(toward) / range : 1.0;
    append(dense, cloud.points[i], (normal * ((toward < 0.0 ? -1.0 : 1.0) / length)).cast<float>(),
           sensor.sigmaAlongNormal(range, cos_incidence), 1.0);
  }
  return dense;
}

OrientedCloud fromPatches(const Patches& patches, PatchWindows& windows, const PointCloud& cloud,
                          const SensorModel& sensor, const SamplingParams& params) {
  const Eigen::Vector3d viewpoint = cloud.viewpoint.cast<double>();
  PatchNormals estimator(patches, windows, viewpoint, sensor, params);
  const std::vector<PatchNormal> normals = estimator.estimate();
  OrientedCloud dense;
  dense.noise_correlation = estimator.noiseCorrelation();
  reserve(dense, patches.size());
  dense.extents.reserve(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Eigen::Vector3d& normal = normals[i].normal;
    if (normal.isZero()) continue;
    const Eigen::Vector3d point = patches.origin + patches.means[i];
    const double count = patches.sums[i][0];
    append(dense, point.cast<float>(), normal.cast<float>(), normals[i].sigma, count);
    dense.extents.push_back(static_cast<float>(patches.extentOf(count, normal, viewpoint - point)));
  }
  return dense;
}

OrientedCloud fromUnorganized(const PointCloud& cloud, const SensorModel& sensor,
                              const SamplingParams& params, std::size_t patch_count) {
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (inRange(p, cloud, sensor)) points.push_back(p);
  }
  if (points.empty()) return {};
  const double edge = spacingForCount(points, patch_count, 0.0);
  if (edge <= 0.0) return {};  // all points are one
  const Patches patches = makeVoxelPatches(points, edge);
  return fromPatches(patches, *nearestPatches(patches), cloud, sensor, params);
}

/// `grid` is filled if the samples are of its patches.
OrientedCloud denseSurface(const PointCloud& cloud, const SensorModel& sensor,
                           const SamplingParams& params, std::shared_ptr<const GridPatches>& grid) {
  if (cloud.hasNormals()) return fromGivenNormals(cloud, sensor);
  const auto patch_count =
      static_cast<std::size_t>(params.patches_per_sample * params.target_samples);
  if (!cloud.organized()) return fromUnorganized(cloud, sensor, params, patch_count);
  grid = std::make_shared<const GridPatches>(makeGridPatches(cloud, sensor, patch_count));
  GridWindows windows(*grid, params.max_window_radius);
  return fromPatches(grid->patches, windows, cloud, sensor, params);
}

/// The middle one of the points' noise levels: most samples need not be closer than it allows.
double medianSigma(std::vector<float> sigmas) {
  if (sigmas.empty()) return 0.0;
  return static_cast<double>(medianOf(std::move(sigmas)));
}

/// Mean extent of each sample's patches [m].
std::vector<float> meanPatchExtents(const OrientedCloud& patches,
                                    const std::vector<int>& sample_of_patch, std::size_t samples) {
  std::vector<float> means(samples), counts(samples);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const auto sample = static_cast<std::size_t>(sample_of_patch[i]);
    means[sample] += patches.extents[i];
    counts[sample] += 1.0F;
  }
  for (std::size_t k = 0; k < samples; ++k) means[k] /= counts[k];
  return means;
}

ScanSurface thinned(OrientedCloud dense, const SamplingParams& params) {
  // Samples at least d apart, drawn one by one, end at 0.547·4/π = 0.70 per d² (jamming limit of
  // discs, Feder 1980); cells of edge h number one per h² of surface.
  const double distance_per_edge = std::sqrt(0.547 * 4.0 / kPi);
  const double edge =
      spacingForCount(dense.points, static_cast<std::size_t>(params.target_samples), 0.0);
  const double spacing =
      std::max(distance_per_edge * edge, params.spacing_per_sigma * medianSigma(dense.sigmas));
  ScanSurface surface;
  if (!(spacing > 0.0)) {
    dense.extents.clear();
    surface.samples = std::move(dense);
    return surface;
  }
  surface.samples = sampleEvenly(dense, spacing, params, &surface.sample_of_patch);
  surface.samples.noise_correlation = dense.noise_correlation;
  if (dense.extents.empty()) return surface;
  surface.samples.patch_extents =
      meanPatchExtents(dense, surface.sample_of_patch, surface.samples.size());
  surface.patches = std::move(dense);
  return surface;
}

/// Appends the samples of `from` for which wanted(i).
template <typename Wanted>
void appendSome(const OrientedCloud& from, const Wanted& wanted, OrientedCloud& to) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (!wanted(i)) continue;
    append(to, from.points[i], from.normals[i], static_cast<double>(from.sigmas[i]),
           static_cast<double>(from.weights[i]));
    to.extents.push_back(static_cast<float>(std::min(from.extent(i), to.spacing)));
    to.patch_extents.push_back(static_cast<float>(std::min(from.patchExtent(i), to.spacing)));
  }
}

}  // namespace

ScanSurface makeScanSurface(const PointCloud& cloud, const SensorModel& sensor,
                            const SamplingParams& params, StageTimings* timings) {
  validate(sensor);
  validate(params);
  check(cloud);
  StageTimings laps = timings == nullptr ? StageTimings() : *timings;
  Stopwatch stopwatch;
  std::shared_ptr<const GridPatches> grid;
  OrientedCloud dense = denseSurface(cloud, sensor, params, grid);
  dense.viewpoint = cloud.viewpoint;
  laps.normals = stopwatch.lap();
  ScanSurface surface = thinned(std::move(dense), params);
  if (surface.patches.size() > 0) surface.grid = std::move(grid);
  laps.sampling = stopwatch.lap();
  if (timings != nullptr) *timings = laps;
  return surface;
}

OrientedCloud makeOrientedCloud(const PointCloud& cloud, const SensorModel& sensor,
                                const SamplingParams& params, StageTimings* timings) {
  return makeScanSurface(cloud, sensor, params, timings).samples;
}

std::size_t splitSamples(ScanSurface& surface, const std::vector<std::uint8_t>& open) {
  const OrientedCloud& samples = surface.samples;
  OrientedCloud split;
  split.spacing = samples.spacing;
  split.viewpoint = samples.viewpoint;
  split.noise_correlation = samples.noise_correlation;
  reserve(split, samples.size() + surface.patches.size());
  appendSome(
      samples, [&](std::size_t i) { return open[i] == 0; }, split);
  const std::size_t begin = split.size();
  appendSome(
      surface.patches,
      [&](std::size_t i) {
        return open[static_cast<std::size_t>(surface.sample_of_patch[i])] != 0;
      },
      split);
  surface = {std::move(split), {}, {}, std::move(surface.grid)};
  return begin;
}

}  // namespace opp
