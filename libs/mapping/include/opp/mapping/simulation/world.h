// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// Flat, simple polygon with holes. Seen from its front the outer ring runs counter-clockwise.
struct Face {
  std::vector<Eigen::Vector3d> outer;               ///< in the map [m], at least 3
  std::vector<std::vector<Eigen::Vector3d>> holes;  ///< in the face's plane, inside `outer` [m]
  Plane plane;                                      ///< of the front: n points to the front
  bool curved = false;  ///< facet that stands for a curved surface: no plane of the truth
};

/// A scene made of flat faces, each with two sides. Side 2f is the front of face f, side 2f + 1 its
/// back. Bodies (boxes, walls) are closed sets of faces whose fronts point outward; they may touch
/// and overlap, only what a ray meets first counts.
class World {
 public:
  /// Adds a face; its front is where `outer` runs counter-clockwise.
  /// \throws std::invalid_argument if a ring has fewer than 3 vertices, is not finite, has no area
  /// or leaves the plane by more than 1e-9 of its extent.
  void addFace(std::vector<Eigen::Vector3d> outer,
               std::vector<std::vector<Eigen::Vector3d>> holes = {}, bool curved = false);

  const std::vector<Face>& faces() const { return faces_; }
  /// Plane of a side; n points to where the side is seen from.
  Plane sidePlane(int side) const;

 private:
  std::vector<Face> faces_;
};

}  // namespace opp::mapping
