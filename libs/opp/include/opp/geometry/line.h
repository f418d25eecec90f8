// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include <Eigen/Core>

#include <optional>

namespace opp {

/// Infinite line through `origin` along the unit vector `direction`.
struct Line {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();

  /// Coordinate along the line of the foot of x [m].
  double parameterOf(const Eigen::Vector3d& x) const { return direction.dot(x - origin); }
  Eigen::Vector3d at(double parameter) const { return origin + parameter * direction; }
};

/// The line on both planes, along n_a × n_b, its origin the point nearest to the frame's origin;
/// nothing if the planes are parallel to within 1e-9 rad.
std::optional<Line> intersect(const Plane& a, const Plane& b);

}  // namespace opp
