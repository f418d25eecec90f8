// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/geometry/plane.h"
#include "opp/geometry/point_cloud.h"
#include "opp/geometry/point_moments.h"
#include "opp/graph/graph_params.h"

#include "cloud/sample_blocks.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp {

/// Gives each sample to the nearest plane whose gates it passes.
class SampleAssigner {
 public:
  SampleAssigner(const OrientedCloud& cloud, const SensorModel& sensor, const GraphParams& params);

  /// A plane and where its samples can be.
  struct LocalPlane {
    Plane plane;
    Eigen::AlignedBox3f reach;
  };

  /// Index of the plane of each sample; −1: none. O(samples near the planes + blocks × planes).
  std::vector<int> assign(const std::vector<LocalPlane>& planes) const;
  /// Index of the first plane whose gates each sample passes; −1: none. With the planes in order of
  /// strength: what each plane explains and no stronger one does.
  std::vector<int> assignToFirst(const std::vector<LocalPlane>& planes) const;
  /// Moments of each plane's samples, weights 1/σ² of the sample [1/m²].
  std::vector<PointMoments> moments(const std::vector<int>& labels, std::size_t planes) const;

 private:
  /// visit(row, distance, normals parallel) for each sample in a block near the plane; the compiler
  /// vectorizes it.
  template <typename Visit>
  void forEachCandidate(const LocalPlane& plane, const Visit& visit) const;
  /// From the order of the blocks to that of the cloud.
  std::vector<int> inCloudOrder(const std::vector<int>& labels) const;

  const OrientedCloud& cloud_;
  SampleBlocks blocks_;  ///< rows of the arrays are in their order
  float cos_normal_gate_;
  double largest_gate_ = 0.0;
  Eigen::ArrayX3f points_, normals_;
  Eigen::ArrayXf gates_;
  std::vector<double> weights_;
};

/// Largest connected patch of a plane's samples.
struct SupportPatch {
  double samples = 0.0;
  double width = 0.0;  ///< of the rectangle with the same least second moment, in mean extents
};

/// What a plane needs: less in clouds with detail, where small planes have patches for samples.
SupportPatch leastSupport(const OrientedCloud& cloud, const GraphParams& params);

/// Mean extent of some samples [m]; 0 if there are none.
double meanExtent(const OrientedCloud& cloud, const std::vector<int>& samples);

/// Samples are connected if they lie in neighbouring cells (8-neighbourhood) of a grid of twice
/// their mean extent. O(n log n).
SupportPatch largestPatch(const OrientedCloud& cloud, const Plane& plane,
                          const std::vector<int>& samples);

/// A plane and its samples, as an edge sees them.
struct EdgeSide {
  const Plane& plane;
  const std::vector<int>& samples;
  double spacing;  ///< mean extent of the samples [m]
};

/// Length of the stretches of the planes' common line along which both have samples within `reach`
/// (in extents of their samples) of it, in extents of the wider spaced ones. Zero for parallel
/// planes.
double commonEdgeLength(const OrientedCloud& cloud, const EdgeSide& a, const EdgeSide& b,
                        double reach);

}  // namespace opp
