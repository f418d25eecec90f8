// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "graph/one_surface.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace opp {
namespace {

/// One surface that nearest-plane assignment cuts in two: each half of a Gaussian has a mean square
/// of 0.36 σ² about its own plane and of 1 σ² about the common one, 2.8 times as much. Two surfaces
/// that `splitLayers` tells apart have at least 6 times as much.
constexpr double kCutByNoise = 4.0;
/// Two planes have 3 parameters more than one. The χ² of 3 degrees of freedom is larger as rarely
/// as a normal variable is beyond 3 standard deviations.
constexpr double kChance = 14.2;

/// Half the length of an even strip with the part's spread along a unit vector [m].
double halfLength(const PointMoments& moments, const Eigen::Vector3d& direction) {
  const double variance = direction.dot(moments.scatter() * direction) / moments.weight();
  return std::sqrt(3.0 * std::max(0.0, variance));
}

}  // namespace

bool sideBySide(const SurfacePart& a, const SurfacePart& b) {
  const Eigen::Vector3d& normal = a.plane.normal();
  Eigen::Vector3d step = b.moments.mean() - a.moments.mean();
  step -= normal.dot(step) * normal;
  const double distance = step.norm();
  if (!(distance > 0.0)) return false;
  const Eigen::Vector3d direction = step / distance;
  return distance > halfLength(a.moments, direction) + halfLength(b.moments, direction);
}

bool isOneSurface(const Plane& common, const SurfacePart& a, const SurfacePart& b, double alike) {
  double own = 0.0, gain = 0.0;
  for (const SurfacePart* part : {&a, &b}) {
    const double own_error = part->moments.squaredError(part->plane);
    const double common_error = part->moments.squaredError(common);
    if (!(common_error <= kCutByNoise * own_error)) return false;
    own += own_error;
    gain += common_error - own_error;
  }
  return gain <= kChance + alike * own || !sideBySide(a, b);
}

}  // namespace opp
