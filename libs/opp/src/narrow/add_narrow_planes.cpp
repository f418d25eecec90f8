// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/add_narrow_planes.h"

#include "opp/cloud/rim_error.h"

#include "cloud/depth_image.h"
#include "cloud/patches.h"
#include "narrow/grow_planes.h"
#include "narrow/open_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace opp {
namespace {

/// Edge of the blocks whose pixels make a sample.
constexpr int kBlock = 4;
/// A block with fewer pixels is at the rim of a plane.
constexpr double kLeastPixels = 4.0;
/// Samples of a plane that are this near to one of its new samples, in the extents of that, have
/// pixels of it.
constexpr float kReplaced = 0.7F;
/// A node is a plane that was found if their normals are as parallel, its middle is on that plane
/// and within its extent.
constexpr double kSameCosine = 0.9;
/// Planes of the graph are this exact where there is no noise, in extents of samples.
constexpr double kRough = 0.01;

bool isNarrow(const PlaneNode& node, const NarrowParams& params) {
  const double extent = node.spacing;
  return rimError(extent * extent, node.moments.variances()[1]).turn > params.max_rim_turn;
}

KnownSurface surfaceOf(const PlaneNode& node, const Eigen::Vector3f& viewpoint) {
  KnownSurface surface;
  surface.normal = node.plane.normal().cast<float>();
  surface.height = static_cast<float>(-node.plane.signedDistance(viewpoint.cast<double>()));
  const Eigen::Vector3f far = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  surface.reach = node.reach.isEmpty() ? Eigen::AlignedBox3f(-far, far)
                                       : Eigen::AlignedBox3f(node.reach.min() - viewpoint,
                                                             node.reach.max() - viewpoint);
  return surface;
}

/// Samples of one plane.
struct NarrowSamples {
  Plane plane;
  std::vector<Eigen::Vector3f> points;
  std::vector<float> sigmas, counts, extents, pixel_extents;

  double meanExtent() const {
    double sum = 0.0;
    for (const float extent : extents) sum += static_cast<double>(extent);
    return sum / static_cast<double>(extents.size());
  }
};

/// Means of the plane's pixels in blocks.
NarrowSamples samplesOf(const PixelPlane& found, const DepthImage& image,
                        const Eigen::Vector3d& viewpoint, double most_extent) {
  struct Entry {
    int block, pixel;
  };
  const int blocks_per_row = image.cols() / kBlock + 1;
  std::vector<Entry> entries;
  for (const int pixel : found.pixels) {
    const int row = pixel / image.cols(), col = pixel % image.cols();
    entries.push_back({row / kBlock * blocks_per_row + col / kBlock, pixel});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.block != b.block ? a.block < b.block : a.pixel < b.pixel;
  });
  NarrowSamples samples;
  samples.plane = Plane::fromPointNormal(viewpoint - found.plane.d() * found.plane.normal(),
                                         found.plane.normal());
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (end = begin; end < entries.size() && entries[end].block == entries[begin].block; ++end) {
      sum += image.point(entries[end].pixel).cast<double>();
    }
    const auto count = static_cast<double>(end - begin);
    if (count < kLeastPixels) continue;
    const Eigen::Vector3d mean = sum / count;
    const double range = mean.norm(), height = found.plane.d();
    const double pixel_area = patchArea(1.0, image.solidAngle(), height, range);
    const auto extentOf = [&](double pixels) {
      return static_cast<float>(std::min(most_extent, std::sqrt(pixels * pixel_area)));
    };
    samples.points.push_back((mean + viewpoint).cast<float>());
    samples.sigmas.push_back(
        static_cast<float>(std::sqrt(image.noise().expected(range * range, height))));
    samples.counts.push_back(static_cast<float>(count));
    samples.extents.push_back(extentOf(count));
    samples.pixel_extents.push_back(extentOf(1.0));
  }
  return samples;
}

PlaneNode nodeOf(const NarrowSamples& samples, const SensorModel& sensor) {
  PlaneNode node;
  node.plane = samples.plane;
  node.spacing = samples.meanExtent();
  node.votes = static_cast<double>(samples.points.size());
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const double sigma = sensor.meanSigma(static_cast<double>(samples.sigmas[i]),
                                          static_cast<double>(samples.counts[i]));
    node.moments.add(samples.points[i].cast<double>(), 1.0 / (sigma * sigma));
    node.reach.extend(samples.points[i]);
  }
  const auto margin = static_cast<float>(node.spacing);
  node.reach.min().array() -= margin;
  node.reach.max().array() += margin;
  return node;
}

/// Marks the samples of patches whose pixels `narrow` has.
void markReplaced(const NarrowSamples& narrow, const Eigen::AlignedBox3f& reach,
                  const OrientedCloud& samples, std::vector<std::uint8_t>& replaced) {
  constexpr float kMostPixels = 1.25F * kBlock * kBlock;  // more: mean of several patches
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3f& point = samples.points[i];
    if (!reach.contains(point) || samples.weights[i] > kMostPixels) continue;
    for (std::size_t k = 0; k < narrow.points.size(); ++k) {
      const float distance = kReplaced * narrow.extents[k];
      if ((narrow.points[k] - point).squaredNorm() < distance * distance) replaced[i] = 1;
    }
  }
}

bool isSame(const PlaneNode& node, const PlaneNode& found) {
  const Eigen::Vector3d middle = node.moments.mean();
  return std::abs(node.plane.normal().dot(found.plane.normal())) > kSameCosine &&
         found.reach.contains(middle.cast<float>()) &&
         std::abs(found.plane.signedDistance(middle)) < found.spacing;
}

/// Whether the samples lie on a plane that is known, beyond where it was thought to reach.
bool liesOn(const NarrowSamples& samples, const PlaneNode& node, const SensorModel& sensor,
            double max_scatter) {
  double sum = 0.0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const double sigma = sensor.meanSigma(static_cast<double>(samples.sigmas[i]),
                                          static_cast<double>(samples.counts[i]));
    const double offset = node.plane.signedDistance(samples.points[i].cast<double>());
    // The plane is not refined yet.
    const double rough = kRough * static_cast<double>(samples.extents[i]);
    sum += offset * offset / (sigma * sigma + rough * rough);
  }
  return sum <= max_scatter * static_cast<double>(samples.points.size());
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
    samples.narrow_samples += plane.points.size();
    append(plane.points, samples.points);
    samples.normals.insert(samples.normals.end(), plane.points.size(),
                           plane.plane.normal().cast<float>());
    append(plane.sigmas, samples.sigmas);
    append(plane.counts, samples.weights);
    append(plane.extents, samples.extents);
    append(plane.pixel_extents, samples.patch_extents);
  }
}

void replaceNodes(const std::vector<std::uint8_t>& replaced, const std::vector<PlaneNode>& found,
                  PlaneGraph& graph) {
  std::vector<int> index(graph.nodes.size(), -1);
  std::vector<PlaneNode> nodes;
  for (std::size_t k = 0; k < graph.nodes.size(); ++k) {
    if (replaced[k] != 0) continue;
    index[k] = static_cast<int>(nodes.size());
    nodes.push_back(graph.nodes[k]);
  }
  nodes.insert(nodes.end(), found.begin(), found.end());
  std::vector<OrthogonalityEdge> edges;
  for (OrthogonalityEdge edge : graph.edges) {
    for (int& plane : edge.planes) plane = index[static_cast<std::size_t>(plane)];
    if (edge.planes[0] >= 0 && edge.planes[1] >= 0) edges.push_back(edge);
  }
  graph.nodes = std::move(nodes);
  graph.edges = std::move(edges);
}

}  // namespace

void addNarrowPlanes(const PointCloud& cloud, const PrimitiveParams& params, OrientedCloud& samples,
                     PlaneGraph& graph) {
  // Without extents the samples were not made of patches.
  if (!cloud.organized() || cloud.columns_wrap || samples.extents.empty()) return;
  const SensorModel sensor = params.sensor.withCorrelation(samples.noise_correlation);
  const DepthImage image(cloud, sensor, params.sampling, sensor.noise_correlation);
  if (!(image.solidAngle() > 0.0)) return;
  std::vector<KnownSurface> surfaces;
  std::vector<std::uint8_t> narrow_nodes, replaced_nodes(graph.nodes.size(), 0);
  for (const PlaneNode& node : graph.nodes) {
    narrow_nodes.push_back(isNarrow(node, params.narrow) ? 1 : 0);
    if (narrow_nodes.back() == 0) surfaces.push_back(surfaceOf(node, cloud.viewpoint));
  }
  const std::vector<PixelPlane> planes = growPlanes(
      image, openPixels(image, surfaces, params.narrow), surfaces, params.narrow,
      params.sampling.max_incidence, params.refinement.max_turn, params.refinement.test_sigmas);
  std::vector<NarrowSamples> added;
  std::vector<PlaneNode> found;
  std::vector<std::uint8_t> replaced(samples.size(), 0);
  for (const PixelPlane& plane : planes) {
    NarrowSamples own = samplesOf(plane, image, cloud.viewpoint.cast<double>(), samples.spacing);
    if (static_cast<int>(own.points.size()) < params.refinement.min_support) continue;
    const PlaneNode node = nodeOf(own, sensor);
    bool is_known = false;
    for (std::size_t k = 0; k < graph.nodes.size(); ++k) {
      if (narrow_nodes[k] != 0) continue;
      if (!liesOn(own, graph.nodes[k], sensor, params.narrow.max_scatter)) continue;
      if (!graph.nodes[k].reach.isEmpty()) graph.nodes[k].reach.extend(node.reach);
      is_known = true;
    }
    if (is_known) continue;
    found.push_back(node);
    markReplaced(own, found.back().reach, samples, replaced);
    for (std::size_t k = 0; k < graph.nodes.size(); ++k) {
      if (narrow_nodes[k] != 0 && isSame(graph.nodes[k], found.back())) replaced_nodes[k] = 1;
    }
    added.push_back(std::move(own));
  }
  if (added.empty()) return;
  replaceSamples(replaced, added, samples);
  replaceNodes(replaced_nodes, found, graph);
}

}  // namespace opp
