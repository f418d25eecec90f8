// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/mapping/registration/surfel_map.h"

#include "registration/match_input.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace opp::mapping {

/// Weight that the Cauchy kernel leaves a residual of so many squared sigmas.
inline double cauchy(double squared_sigmas, double kernel_width) {
  return 1.0 / (1.0 + squared_sigmas / (kernel_width * kernel_width));
}

/// A point and what it was found to lie on.
struct PointMatch {
  Eigen::Vector3d arm;     ///< from the body's origin to the point, in the map's frame [m]
  Eigen::Vector3d normal;  ///< of the surface
  double residual;         ///< [m]
  double variance;         ///< of the residual [m²]
  double kernel;           ///< influence that the robust kernel leaves it, 0–1
  int landmark;            ///< of the surface; −1: none

  /// The kernel leaves the point some influence.
  bool agrees() const { return kernel > 0.1; }
};

struct PointMatching {
  double kernel_width = 1.0;    ///< of the Cauchy kernel, in sigmas
  double extra_variance = 0.0;  ///< of every residual [m²]
};

/// Calls f(point, match) for each point that finds a surfel, in order. All surfels of a landmark
/// share its normal: the noise of their own would tell, falsely, of motion along the surface.
template <typename F>
void forEachPointMatch(const std::vector<ScanPoint>& points, const Eigen::Isometry3d& map_from_body,
                       const SurfelMap& surfels, const std::vector<Plane>& landmarks,
                       const PointMatching& matching, F&& f) {
  const Eigen::Isometry3f pose = map_from_body.cast<float>();
  for (const ScanPoint& p : points) {
    const Eigen::Vector3f arm = pose.linear() * p.point_in_body;
    const Eigen::Vector3f point = arm + pose.translation();
    const Surfel* surfel = surfels.closest(point, pose.linear() * p.normal_in_body);
    if (surfel == nullptr) continue;
    PointMatch match{arm.cast<double>(), surfel->normal.cast<double>(), 0.0, 0.0, 0.0,
                     surfel->landmark};
    if (surfel->landmark >= 0)
      match.normal = landmarks[static_cast<std::size_t>(surfel->landmark)].normal();
    match.residual = match.normal.dot((point - surfel->mean).cast<double>());
    match.variance = p.variance + 1.0 / surfel->weight + matching.extra_variance;
    match.kernel = cauchy(match.residual * match.residual / match.variance, matching.kernel_width);
    f(p, match);
  }
}

}  // namespace opp::mapping
