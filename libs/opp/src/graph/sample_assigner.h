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

}  // namespace opp
