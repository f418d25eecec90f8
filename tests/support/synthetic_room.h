// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/geometry/point_cloud.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace opp::test {

/// A rectangle in space: center ± half_u ± half_v with half_u ⊥ half_v. It can be seen from the
/// side of half_u × half_v only.
struct Rectangle {
  Eigen::Vector3d center, half_u, half_v;
  Plane plane() const { return Plane::fromPointNormal(center, half_u.cross(half_v)); }
};

using Rectangles = std::vector<Rectangle>;

/// The six sides of an axis-aligned box from `low` to `high`, seen from inside (a room).
Rectangles roomSides(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
/// The same sides seen from outside (a cupboard, a cube).
Rectangles boxSides(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
/// A room of about 5 × 4 × 2.5 m with its floor at z = 0 and (0, 0) inside; a cupboard on a wall
/// and a desk (a slab on two side panels) at random places.
Rectangles furnishedRoom(std::uint64_t seed);

struct SyntheticOptions {
  double spacing = 0.05;       ///< [m] between samples
  double sigma = 0.0;          ///< [m] noise of a sample along the normal
  double normal_sigma = 0.0;   ///< [rad] noise of a normal about either tangent
  double outlier_ratio = 0.0;  ///< outliers (random place in the scene's bounding box, random
                               ///< normal) per surface sample
  bool flip_normals = false;   ///< give each normal a random sign
  bool occlusion = true;       ///< leave out what another rectangle hides from the viewpoint
  int min_plane_samples = 20;  ///< planes with fewer visible samples are not in the truth
  std::uint64_t seed = 0;
};

/// Samples of a scene and the exact truth. Coplanar rectangles are one plane.
struct SyntheticScene {
  OrientedCloud cloud;
  std::vector<int> labels;    ///< per sample: index into planes; −1: outlier or too small a plane
  std::vector<Plane> planes;  ///< n points to the viewpoint's side
  std::vector<int> counts;    ///< samples of each plane
  /// Pairs of orthogonal planes that have samples within 2.5 spacings of each other, ascending.
  std::vector<std::array<int, 2>> edges;
};

/// Samples the sides of `rectangles` that face `viewpoint`, then moves all by `cloud_from_scene`.
SyntheticScene sampleScene(const Rectangles& rectangles, const Eigen::Vector3d& viewpoint,
                           const Eigen::Isometry3d& cloud_from_scene,
                           const SyntheticOptions& options);

}  // namespace opp::test
