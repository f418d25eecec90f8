// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud/lanes.h"

#include <Eigen/Core>

namespace opp {

/// A plane fitted to points whose noise differs by direction.
struct NoisyPlane {
  Eigen::Vector3d normal;  ///< unit length, either sign; not finite: the points do not fix it
  double width;            ///< smaller variance of the points in the plane, without the noise [m²]
  Eigen::Matrix3d surface;  ///< covariance of the points without the noise [m²]
};

/// One of each problem.
struct NoisyPlanes {
  VectorLanes normal;
  Lanes width;
  SymmetricLanes surface;
  NoisyPlane operator[](int lane) const;
};

/// Unit normals and smaller tangential variances of points with these covariances, whose noise is
/// `along` in the direction of the unit vector `ray` and `across` in the others. The normal n
/// minimizes nᵀCn / nᵀΣn, Σ the noise's covariance. Plain least squares (Σ = I) would turn slanted
/// surfaces toward the sensor by several degrees, because noise along the ray spreads the points
/// in the plane as well.
NoisyPlanes fitNoisyPlanes(const SymmetricLanes& covariance, const VectorLanes& ray,
                           const Lanes& along, double across);

/// Unit tangent along which the points extend less.
Eigen::Vector3d narrowDirection(const NoisyPlane& plane);

}  // namespace opp
