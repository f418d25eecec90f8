// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/line.h"

#include <Eigen/Geometry>

namespace opp {

std::optional<Line> intersect(const Plane& a, const Plane& b) {
  constexpr double kParallel = 1e-9;
  const Eigen::Vector3d direction = a.normal().cross(b.normal());
  const double sine = direction.norm();
  if (sine < kParallel) return std::nullopt;
  // The origin solves n_a·x = −d_a, n_b·x = −d_b, direction·x = 0.
  const Eigen::Vector3d origin =
      (-a.d() * b.normal().cross(direction) - b.d() * direction.cross(a.normal())) / (sine * sine);
  return Line{origin, direction / sine};
}

}  // namespace opp
