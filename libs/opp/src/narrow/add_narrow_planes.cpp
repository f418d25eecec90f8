// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/add_narrow_planes.h"

#include "opp/cloud/rim_error.h"

#include "cloud/depth_image.h"
#include "narrow/grow_planes.h"
#include "narrow/narrow_samples.h"
#include "narrow/open_pixels.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace opp {
namespace {

/// A node is a plane that was found if their normals are as parallel, its middle is on that plane
/// and within its extent.
constexpr double kSameCosine = 0.9;
/// Planes of the graph are this exact where there is no noise, in extents of samples.
constexpr double kRough = 0.01;

bool isNarrow(const PlaneNode& node, const NarrowParams& params) {
  const double extent = node.spacing;
  return rimError(extent * extent, node.moments.variances()[1]).turn > params.max_rim_turn;
}

KnownSurface surfaceOf(const PlaneNode& node, const Eigen::Vector3f& viewpoint,
                       const PointNoise& noise) {
  const double d = node.plane.signedDistance(viewpoint.cast<double>());
  const Plane about_viewpoint =
      Plane::fromPointNormal(-d * node.plane.normal(), node.plane.normal());
  const Eigen::Vector3f far = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  if (node.reach.isEmpty()) return {about_viewpoint, Eigen::AlignedBox3f(-far, far), noise};
  return {about_viewpoint,
          Eigen::AlignedBox3f(node.reach.min() - viewpoint, node.reach.max() - viewpoint), noise};
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
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double offset = node.plane.signedDistance(samples.points[i].cast<double>());
    // The plane is not refined yet.
    const double rough = kRough * static_cast<double>(samples.extents[i]);
    sum += offset * offset / (samples.variance(i, sensor) + rough * rough);
  }
  return sum <= max_scatter * static_cast<double>(samples.size());
}

/// Puts planes that were found pixel by pixel into a graph.
class NarrowPlaneAdder {
 public:
  /// All must outlive this. \param narrow_nodes per node: 1: planes found may take its place.
  NarrowPlaneAdder(const PrimitiveParams& params, const SensorModel& sensor,
                   const std::vector<std::uint8_t>& narrow_nodes, OrientedCloud& samples,
                   PlaneGraph& graph)
      : params_(params),
        sensor_(sensor),
        narrow_nodes_(narrow_nodes),
        samples_(samples),
        graph_(graph),
        replaced_samples_(samples.size(), 0),
        replaced_nodes_(graph.nodes.size(), 0) {}

  void add(NarrowSamples own) {
    if (static_cast<int>(own.size()) < params_.refinement.min_support) return;
    const PlaneNode node = nodeOf(own, sensor_);
    if (extendsKnown(own, node)) return;
    markReplaced(own, node.reach, samples_, replaced_samples_);
    for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
      if (narrow_nodes_[k] != 0 && isSame(graph_.nodes[k], node)) replaced_nodes_[k] = 1;
    }
    added_.push_back(std::move(own));
    found_.push_back(node);
  }

  /// Call once, at the end.
  void finish() {
    if (found_.empty()) return;
    replaceSamples(replaced_samples_, added_, samples_);
    replaceNodes();
  }

 private:
  /// Whether the samples lie on planes of the graph; these then reach as far.
  bool extendsKnown(const NarrowSamples& own, const PlaneNode& node) {
    bool is_known = false;
    for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
      PlaneNode& known = graph_.nodes[k];
      if (narrow_nodes_[k] != 0) continue;
      if (!liesOn(own, known, sensor_, params_.narrow.max_scatter)) continue;
      if (!known.reach.isEmpty()) known.reach.extend(node.reach);
      is_known = true;
    }
    return is_known;
  }

  void replaceNodes() {
    std::vector<int> index(graph_.nodes.size(), -1);
    std::vector<PlaneNode> nodes;
    for (std::size_t k = 0; k < graph_.nodes.size(); ++k) {
      if (replaced_nodes_[k] != 0) continue;
      index[k] = static_cast<int>(nodes.size());
      nodes.push_back(graph_.nodes[k]);
    }
    nodes.insert(nodes.end(), found_.begin(), found_.end());
    std::vector<OrthogonalityEdge> edges;
    for (OrthogonalityEdge edge : graph_.edges) {
      for (int& plane : edge.planes) plane = index[static_cast<std::size_t>(plane)];
      if (edge.planes[0] >= 0 && edge.planes[1] >= 0) edges.push_back(edge);
    }
    graph_.nodes = std::move(nodes);
    graph_.edges = std::move(edges);
  }

  const PrimitiveParams& params_;
  const SensorModel& sensor_;
  const std::vector<std::uint8_t>& narrow_nodes_;
  OrientedCloud& samples_;
  PlaneGraph& graph_;
  std::vector<std::uint8_t> replaced_samples_, replaced_nodes_;
  std::vector<NarrowSamples> added_;
  std::vector<PlaneNode> found_;
};

}  // namespace

void addNarrowPlanes(const PointCloud& cloud, const GridPatches& grid,
                     const PrimitiveParams& params, OrientedCloud& samples, PlaneGraph& graph) {
  if (cloud.columns_wrap) return;
  const SensorModel sensor = params.sensor.withCorrelation(samples.noise_correlation);
  const DepthImage image(cloud, sensor, params.sampling);
  if (!(image.solidAngle() > 0.0)) return;
  std::vector<KnownSurface> surfaces;
  std::vector<std::uint8_t> narrow_nodes;
  for (const PlaneNode& node : graph.nodes) {
    narrow_nodes.push_back(isNarrow(node, params.narrow) ? 1 : 0);
    if (narrow_nodes.back() == 0)
      surfaces.push_back(surfaceOf(node, cloud.viewpoint, image.noise()));
  }
  const RegionRule rule{params.narrow, params.sampling.max_incidence, params.refinement.max_turn,
                        params.refinement.test_sigmas};
  NarrowPlaneAdder adder(params, sensor, narrow_nodes, samples, graph);
  for (const PixelPlane& plane :
       growPlanes(image, openPixels(image, grid, surfaces, params.narrow), surfaces, rule)) {
    adder.add(narrowSamples(plane, image, cloud.viewpoint.cast<double>(), samples.spacing));
  }
  adder.finish();
}

}  // namespace opp
