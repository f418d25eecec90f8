// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/plane.h"

#include <cmath>
#include <ostream>
#include <stdexcept>

namespace opp {

Plane Plane::fromCoefficients(const Eigen::Vector3d& normal, double d) {
  const double norm = normal.stableNorm();
  if (!(norm > 0.0) || !std::isfinite(norm) || !std::isfinite(d)) {
    throw std::invalid_argument(
        "a plane needs a finite normal that is not zero and a finite offset");
  }
  return Plane(normal / norm, d / norm);
}

Plane Plane::fromPointNormal(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  return fromCoefficients(normal, -normal.dot(point));
}

Plane Plane::fromUnitNormal(const Eigen::Vector3d& unit_normal, double d) {
  constexpr double kRounding = 1e-12;
  if (!(std::abs(unit_normal.squaredNorm() - 1.0) <= kRounding) || !std::isfinite(d))
    throw std::invalid_argument("a plane needs a normal of length 1 and a finite offset");
  return Plane(unit_normal, d);
}

Plane Plane::flipped() const { return Plane(-normal_, -d_); }

Plane transformed(const Eigen::Isometry3d& b_from_a, const Plane& plane_in_a) {
  const Eigen::Vector3d normal_in_b = b_from_a.linear() * plane_in_a.normal();
  return Plane::fromCoefficients(normal_in_b,
                                 plane_in_a.d() - normal_in_b.dot(b_from_a.translation()));
}

double angleBetween(const Plane& a, const Plane& b) {
  return std::atan2(a.normal().cross(b.normal()).norm(), a.normal().dot(b.normal()));
}

Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& normal) {
  // Branch-free frame of Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
  const double sign = std::copysign(1.0, normal.z());
  const double a = -1.0 / (sign + normal.z());
  const double b = normal.x() * normal.y() * a;
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) << 1.0 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x();
  basis.col(1) << b, sign + normal.y() * normal.y() * a, -normal.y();
  return basis;
}

Plane perturbed(const Plane& plane, const Eigen::Vector3d& alpha_beta_delta) {
  const Eigen::Vector3d normal =
      (plane.normal() + tangentBasis(plane.normal()) * alpha_beta_delta.head<2>()).normalized();
  return Plane::fromCoefficients(normal, plane.d() + alpha_beta_delta.z());
}

std::ostream& operator<<(std::ostream& os, const Plane& plane) {
  return os << "Plane(n = " << plane.normal().transpose() << ", d = " << plane.d() << ")";
}

}  // namespace opp
