// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace opp {

/// How far apart the samples of a plane may stand along a direction in it, in their extents; at
/// least 1. A square of rays of edge e covers e/cos of the plane in the direction in which the rays
/// slant, e in the other; the extent is the edge of the square of equal area, e/√cos.
/// \param direction unit vector in the plane of normal `normal`.
/// \param ray from the viewpoint to the sample [m]; 1 if it has no length.
inline double pitchAlong(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal,
                         const Eigen::Vector3d& ray) {
  constexpr double kLeastCosine = 0.1;  // as for extents
  const double range = ray.norm();
  if (!(range > 0.0)) return 1.0;
  const double cosine = std::max(std::abs(normal.dot(ray)) / range, kLeastCosine);
  const double slant = direction.dot(ray) / range;
  return std::max(1.0, std::sqrt(cosine + slant * slant / cosine));
}

}  // namespace opp
