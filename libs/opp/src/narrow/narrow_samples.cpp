// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/narrow_samples.h"

#include "cloud/patches.h"
#include "narrow/pixel_blocks.h"

#include <algorithm>
#include <cmath>

namespace opp {
namespace {

/// A block with fewer pixels is at the rim of a plane.
constexpr double kLeastPixels = 4.0;
/// Samples of patches that are this near to one of the new samples, in the extents of that, have
/// pixels of it.
constexpr float kReplaced = 0.7F;
/// A sample of more pixels is the mean of several patches.
constexpr float kMostPixels = 1.25F * kPatchEdge * kPatchEdge;

}  // namespace

double NarrowSamples::variance(std::size_t i, const SensorModel& sensor) const {
  const double sigma =
      sensor.meanSigma(static_cast<double>(sigmas[i]), static_cast<double>(weights[i]));
  return sigma * sigma;
}

NarrowSamples narrowSamples(const PixelPlane& found, const DepthImage& image,
                            const Eigen::Vector3d& viewpoint, double max_extent) {
  NarrowSamples samples;
  samples.plane = Plane::fromPointNormal(viewpoint - found.plane.d() * found.plane.normal(),
                                         found.plane.normal());
  const double height = found.plane.d();
  for (const PixelBlock& block : pixelBlocks(image, found.pixels, kPatchEdge)) {
    if (block.count < kLeastPixels) continue;
    const double range = block.point.norm();
    const double pixel_area = patchArea(1.0, image.solidAngle(), height, range);
    const auto extentOf = [&](double pixels) {
      return static_cast<float>(std::min(max_extent, std::sqrt(pixels * pixel_area)));
    };
    samples.points.push_back((block.point + viewpoint).cast<float>());
    samples.sigmas.push_back(
        static_cast<float>(std::sqrt(image.noise().expected(range * range, height))));
    samples.weights.push_back(static_cast<float>(block.count));
    samples.extents.push_back(extentOf(block.count));
    samples.patch_extents.push_back(extentOf(1.0));
  }
  return samples;
}

PlaneNode nodeOf(const NarrowSamples& samples, const SensorModel& sensor) {
  PlaneNode node;
  node.plane = samples.plane;
  node.votes = static_cast<double>(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    node.moments.add(samples.points[i].cast<double>(), 1.0 / samples.variance(i, sensor));
    node.reach.extend(samples.points[i]);
    node.spacing += static_cast<double>(samples.extents[i]);
  }
  node.spacing /= static_cast<double>(samples.size());
  const auto margin = static_cast<float>(node.spacing);
  node.reach.min().array() -= margin;
  node.reach.max().array() += margin;
  return node;
}

void markReplaced(const NarrowSamples& narrow, const Eigen::AlignedBox3f& reach,
                  const OrientedCloud& samples, std::vector<std::uint8_t>& replaced) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3f& point = samples.points[i];
    if (!reach.contains(point) || samples.weights[i] > kMostPixels) continue;
    for (std::size_t k = 0; k < narrow.size(); ++k) {
      const float distance = kReplaced * narrow.extents[k];
      if ((narrow.points[k] - point).squaredNorm() < distance * distance) replaced[i] = 1;
    }
  }
}

void replaceSamples(const std::vector<std::uint8_t>& replaced,
                    const std::vector<NarrowSamples>& narrow, OrientedCloud& samples) {
  std::size_t kept = 0;
  const auto move = [&](auto& values, std::size_t i) { values[kept] = values[i]; };
  for (std::size_t i = 0; i < replaced.size(); ++i) {
    if (replaced[i] != 0) continue;
    move(samples.points, i), move(samples.normals, i), move(samples.sigmas, i);
    move(samples.weights, i), move(samples.extents, i), move(samples.patch_extents, i);
    ++kept;
  }
  const auto cut = [&](auto& values) { values.resize(kept); };
  cut(samples.points), cut(samples.normals), cut(samples.sigmas);
  cut(samples.weights), cut(samples.extents), cut(samples.patch_extents);
  const auto append = [](const auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (const NarrowSamples& plane : narrow) {
    samples.narrow_samples += plane.size();
    append(plane.points, samples.points);
    samples.normals.insert(samples.normals.end(), plane.size(), plane.plane.normal().cast<float>());
    append(plane.sigmas, samples.sigmas), append(plane.weights, samples.weights);
    append(plane.extents, samples.extents), append(plane.patch_extents, samples.patch_extents);
  }
}

}  // namespace opp
