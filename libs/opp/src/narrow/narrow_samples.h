// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/geometry/point_cloud.h"
#include "opp/graph/plane_graph.h"

#include "cloud/depth_image.h"
#include "narrow/grow_planes.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// Samples of one plane; the vectors are as in OrientedCloud.
struct NarrowSamples {
  Plane plane;  ///< in the cloud's frame
  std::vector<Eigen::Vector3f> points;
  std::vector<float> sigmas, weights, extents, patch_extents;

  std::size_t size() const { return points.size(); }
  /// Of a sample's offset from the plane [m²].
  double variance(std::size_t i, const SensorModel& sensor) const;
};

/// Means of the plane's pixels in blocks, with extents of at most `max_extent`.
NarrowSamples narrowSamples(const PixelPlane& found, const DepthImage& image,
                            const Eigen::Vector3d& viewpoint, double max_extent);

/// The plane as a node of the graph.
PlaneNode nodeOf(const NarrowSamples& samples, const SensorModel& sensor);

/// Marks the samples of patches whose pixels `narrow`, whose node reaches so far, has.
/// O(samples + samples near × narrow ones).
void markReplaced(const NarrowSamples& narrow, const Eigen::AlignedBox3f& reach,
                  const OrientedCloud& samples, std::vector<std::uint8_t>& replaced);

/// Leaves out the samples that are marked and appends the others.
void replaceSamples(const std::vector<std::uint8_t>& replaced,
                    const std::vector<NarrowSamples>& narrow, OrientedCloud& samples);

}  // namespace opp
