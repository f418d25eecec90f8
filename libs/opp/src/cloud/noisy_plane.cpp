// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/noisy_plane.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace opp {
namespace {

/// The least eigenvalue of a symmetric, positive semidefinite matrix and a unit eigenvector (not
/// finite if the eigenvalue is multiple). Eigen's closed form takes twice the time, which is the
/// largest share of the whole stage.
std::pair<double, Eigen::Vector3d> leastEigenpair(const Eigen::Matrix3d& a) {
  const double xy = a(0, 1), xz = a(0, 2), yz = a(1, 2);
  const double trace = a.trace();
  const double minors =
      a(0, 0) * a(1, 1) - xy * xy + a(0, 0) * a(2, 2) - xz * xz + a(1, 1) * a(2, 2) - yz * yz;
  const double determinant = a.determinant();
  // Newton's steps on det(A − λI) from λ = 0 rise to its least root and never pass it.
  // They converge quadratically: after a rise of 10⁻⁸ of the trace the rest is rounding.
  constexpr int kMaxSteps = 30;  // 3 are usual
  constexpr double kLastRise = 1e-8;
  double least = 0.0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const double value = determinant - least * (minors - least * (trace - least));
    const double slope = minors - least * (2.0 * trace - 3.0 * least);
    const double rise = slope > 0.0 ? value / slope : 0.0;
    least += rise;
    if (!(rise > kLastRise * trace)) break;
  }
  // The eigenvector is orthogonal to the rows of A − λI.
  const Eigen::Matrix3d rows = a - least * Eigen::Matrix3d::Identity();
  Eigen::Vector3d best = rows.row(0).cross(rows.row(1));
  for (int k = 1; k < 3; ++k) {
    const Eigen::Vector3d other = rows.row(k).cross(rows.row((k + 1) % 3));
    if (other.squaredNorm() > best.squaredNorm()) best = other;
  }
  return {least, best / best.norm()};
}

}  // namespace

NoisyPlane fitNoisyPlane(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& ray,
                         double along, double across) {
  const double squeeze = across / along, shrink = 1.0 - squeeze;
  // W C W with W = I − shrink ray rayᵀ, without products of matrices.
  const Eigen::Vector3d along_ray = covariance * ray;
  const Eigen::Vector3d half =
      shrink * along_ray - (0.5 * shrink * shrink * ray.dot(along_ray)) * ray;
  const Eigen::Matrix3d cross = half * ray.transpose();
  const auto [least, whitened_normal] = leastEigenpair(covariance - cross - cross.transpose());
  const Eigen::Vector3d normal =
      (whitened_normal - (shrink * ray.dot(whitened_normal)) * ray).normalized();
  // C − λΣ has the normal in its kernel; its other eigenvalues are the widths of the surface.
  const double stretch = 1.0 / (squeeze * squeeze) - 1.0;
  const Eigen::Matrix3d surface =
      covariance - least * (Eigen::Matrix3d::Identity() + stretch * ray * ray.transpose());
  const double sum = surface.trace();
  const double product = surface(0, 0) * surface(1, 1) - surface(0, 1) * surface(0, 1) +
                         surface(0, 0) * surface(2, 2) - surface(0, 2) * surface(0, 2) +
                         surface(1, 1) * surface(2, 2) - surface(1, 2) * surface(1, 2);
  const double larger = 0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4.0 * product)));
  const double smaller = larger > 0.0 ? product / larger : 0.0;
  return {normal, smaller, surface};
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
