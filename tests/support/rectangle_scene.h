// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"
#include "opp/graph/plane_graph.h"

#include "support/random.h"

#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace opp::test {

/// { origin + s·u + t·v, 0 ≤ s, t ≤ 1 }.
struct Rectangle {
  Eigen::Vector3d origin, u, v;
};

/// The six faces of an axis-aligned box, in the order −x, +x, −y, +y, −z, +z.
std::vector<Rectangle> boxFaces(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// Scene of rectangles that meet as `edges` says, and the noise of its samples.
struct RectangleScene {
  std::vector<Rectangle> rectangles;
  std::vector<std::array<int, 2>> edges;  ///< ascending pairs
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();
  double spacing = 0.05;       ///< [m]
  double sigma = 0.0;          ///< of each sample along its normal [m]
  double normal_sigma = 0.02;  ///< of each component of the samples' normals [rad]

  /// Plane of a rectangle, normal to the viewpoint's side.
  Plane plane(std::size_t index) const;
  /// Samples of all rectangles (no occlusion), a jittered grid each; sigmas are at least 1 µm.
  OrientedCloud sample(Random& random) const;
  /// True planes turned by up to `angle` [rad] about their centres and moved by up to `offset` [m].
  PlaneGraph rough(Random& random, double angle, double offset) const;
  /// Everything moved to another frame.
  RectangleScene transformed(const Eigen::Isometry3d& b_from_a) const;
};

/// Box with all 12 edges: a room with the viewpoint inside, a cube with it outside.
RectangleScene boxScene(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

}  // namespace opp::test
