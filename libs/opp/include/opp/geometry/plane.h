// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <iosfwd>

namespace opp {

/// Hesse plane { x : n·x + d = 0 } with |n| = 1 and d [m] the signed distance of the origin.
/// n points to the side from which the plane was seen. Same sign of d as MRPT's TPlane.
class Plane {
 public:
  /// The plane z = 0.
  Plane() : normal_(Eigen::Vector3d::UnitZ()), d_(0.0) {}

  /// Plane with `normal` (any length) through `point`.
  /// \throws std::invalid_argument if the normal is zero or not finite.
  static Plane fromPointNormal(const Eigen::Vector3d& point, const Eigen::Vector3d& normal);

  /// Plane normal·x + d = 0; normal and d are scaled together to |normal| = 1.
  /// \throws std::invalid_argument if the normal is zero or not finite.
  static Plane fromCoefficients(const Eigen::Vector3d& normal, double d);

  /// Plane of exactly these numbers: one that was stored comes back to the bit, which scaling to
  /// |normal| = 1 once more would not do.
  /// \throws std::invalid_argument if |normal| is not 1 but for rounding, or d is not finite.
  static Plane fromUnitNormal(const Eigen::Vector3d& unit_normal, double d);

  const Eigen::Vector3d& normal() const { return normal_; }
  double d() const { return d_; }
  /// (n, d) as a homogeneous 4-vector π, so that π·(x,1) is the signed distance.
  Eigen::Vector4d coefficients() const { return {normal_.x(), normal_.y(), normal_.z(), d_}; }

  /// n·x + d [m]; positive on the side that n points to.
  double signedDistance(const Eigen::Vector3d& x) const { return normal_.dot(x) + d_; }
  /// Foot of the perpendicular from x.
  Eigen::Vector3d project(const Eigen::Vector3d& x) const {
    return x - signedDistance(x) * normal_;
  }
  /// The same point set seen from the other side: (−n, −d).
  Plane flipped() const;

 private:
  Plane(const Eigen::Vector3d& unit_normal, double d) : normal_(unit_normal), d_(d) {}
  Eigen::Vector3d normal_;
  double d_;
};

/// The plane expressed in frame b: n_b = R n_a, d_b = d_a − n_b·t.
Plane transformed(const Eigen::Isometry3d& b_from_a, const Plane& plane_in_a);

/// Angle between the normals in [0, π] [rad]; accurate near 0, π/2 and π (atan2, not acos).
double angleBetween(const Plane& a, const Plane& b);

/// Two unit vectors (columns) that complete the unit vector `normal` to a right-handed frame
/// (t1, t2, normal). Depends on `normal` alone. Covariances of planes are given in this basis:
/// (α, β, δ) stands for n' = normalize(n + α t1 + β t2), d' = d + δ.
Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& normal);

/// Moves a plane by (α, β, δ) in the basis of `tangentBasis`.
Plane perturbed(const Plane& plane, const Eigen::Vector3d& alpha_beta_delta);

std::ostream& operator<<(std::ostream& os, const Plane& plane);

}  // namespace opp
