// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/mapping/simulation/world.h"

#include "planar/geos.h"

#include <Eigen/Core>

namespace opp::mapping {

/// Two coordinates on a plane, right-handed with its normal: counter-clockwise seen from the front
/// is counter-clockwise in (u, v).
class PlaneCoordinates {
 public:
  explicit PlaneCoordinates(const Plane& plane)
      : origin_(-plane.d() * plane.normal()), axes_(tangentBasis(plane.normal())) {}

  Eigen::Vector2d uv(const Eigen::Vector3d& point) const {
    return axes_.transpose() * (point - origin_);
  }
  Eigen::Vector3d point(const Eigen::Vector2d& uv) const { return origin_ + axes_ * uv; }
  Ring2d ring(const std::vector<Eigen::Vector3d>& vertices) const {
    Ring2d result;
    for (const auto& vertex : vertices) result.push_back(uv(vertex));
    return result;
  }
  Polygon2d polygon(const Face& face) const {
    Polygon2d result{ring(face.outer), {}};
    for (const auto& hole : face.holes) result.holes.push_back(ring(hole));
    return result;
  }

 private:
  Eigen::Vector3d origin_;
  Eigen::Matrix<double, 3, 2> axes_;
};

}  // namespace opp::mapping
