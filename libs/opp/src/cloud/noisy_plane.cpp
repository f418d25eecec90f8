// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/noisy_plane.h"

#include <Eigen/Geometry>

namespace opp {
namespace {

/// A − factor·I.
SymmetricLanes lessened(const SymmetricLanes& a, const Lanes& factor) {
  return {a.xx - factor, a.xy, a.xz, a.yy - factor, a.yz, a.zz - factor};
}

/// The least eigenvalue of symmetric, positive semidefinite matrices.
Lanes leastEigenvalue(const SymmetricLanes& a) {
  const Lanes trace = a.trace(), minors = a.minors(), determinant = a.determinant();
  // Newton's steps on det(A − λI) from λ = 0 rise to its least root and never pass it.
  // They converge quadratically: after a rise of 10⁻⁸ of the trace the rest is rounding.
  constexpr int kMaxSteps = 30;  // 3 are usual
  constexpr double kLastRise = 1e-8;
  Lanes least = Lanes::Zero();
  for (int step = 0; step < kMaxSteps; ++step) {
    const Lanes value = determinant - least * (minors - least * (trace - least));
    const Lanes slope = minors - least * (2.0 * trace - 3.0 * least);
    const Lanes rise = whereGreater(slope, Lanes::Zero(), value / slope, Lanes::Zero());
    least += rise;
    if (!((rise - kLastRise * trace).maxCoeff() > 0.0)) break;
  }
  return least;
}

/// Unit eigenvectors of an eigenvalue; not finite if it is multiple.
VectorLanes eigenvector(const SymmetricLanes& a, const Lanes& eigenvalue) {
  // It is orthogonal to the rows of A − λI.
  const SymmetricLanes rows = lessened(a, eigenvalue);
  const VectorLanes x{rows.xx, rows.xy, rows.xz}, y{rows.xy, rows.yy, rows.yz},
      z{rows.xz, rows.yz, rows.zz};
  VectorLanes best = cross(x, y);
  for (const VectorLanes& other : {cross(y, z), cross(z, x)}) {
    const Lanes size = best.squaredNorm(), other_size = other.squaredNorm();
    best = {whereGreater(other_size, size, other.x, best.x),
            whereGreater(other_size, size, other.y, best.y),
            whereGreater(other_size, size, other.z, best.z)};
  }
  return normalized(best);
}

/// W C W with W = I − shrink ray rayᵀ.
SymmetricLanes whitened(const SymmetricLanes& c, const VectorLanes& ray, const Lanes& shrink) {
  const VectorLanes along = c * ray;
  const Lanes half = 0.5 * shrink * shrink * dot(ray, along);
  const VectorLanes h{shrink * along.x - half * ray.x, shrink * along.y - half * ray.y,
                      shrink * along.z - half * ray.z};
  return {c.xx - 2.0 * h.x * ray.x,           c.xy - (h.x * ray.y + h.y * ray.x),
          c.xz - (h.x * ray.z + h.z * ray.x), c.yy - 2.0 * h.y * ray.y,
          c.yz - (h.y * ray.z + h.z * ray.y), c.zz - 2.0 * h.z * ray.z};
}

}  // namespace

NoisyPlane NoisyPlanes::operator[](int lane) const {
  return {normal[lane], width[lane], surface[lane]};
}

NoisyPlanes fitNoisyPlanes(const SymmetricLanes& covariance, const VectorLanes& ray,
                           const Lanes& along, double across) {
  const Lanes squeeze = across / along, shrink = 1.0 - squeeze;
  const SymmetricLanes white = whitened(covariance, ray, shrink);
  const Lanes least = leastEigenvalue(white);
  const VectorLanes n = eigenvector(white, least);
  const Lanes back = shrink * dot(ray, n);
  NoisyPlanes planes;
  planes.normal = normalized({n.x - back * ray.x, n.y - back * ray.y, n.z - back * ray.z});
  // C − λΣ has the normal in its kernel; its other eigenvalues are the widths of the surface.
  const Lanes stretch = least * (1.0 / (squeeze * squeeze) - 1.0);
  const SymmetricLanes c = lessened(covariance, least);
  planes.surface = {c.xx - stretch * ray.x * ray.x, c.xy - stretch * ray.x * ray.y,
                    c.xz - stretch * ray.x * ray.z, c.yy - stretch * ray.y * ray.y,
                    c.yz - stretch * ray.y * ray.z, c.zz - stretch * ray.z * ray.z};
  const Lanes sum = planes.surface.trace(), product = planes.surface.minors();
  const Lanes larger = 0.5 * (sum + (sum * sum - 4.0 * product).max(0.0).sqrt());
  planes.width = whereGreater(larger, Lanes::Zero(), product / larger, Lanes::Zero());
  return planes;
}

Eigen::Vector3d narrowDirection(const NoisyPlane& plane) {
  // What is left without the narrow part is the wide direction times its transpose.
  const Eigen::Vector3d& normal = plane.normal;
  const Eigen::Matrix3d wide =
      plane.surface - plane.width * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
  Eigen::Index column = 0;
  wide.diagonal().maxCoeff(&column);
  return normal.cross(wide.col(column)).normalized();
}

}  // namespace opp
