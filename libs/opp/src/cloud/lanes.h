// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace opp {

/// So many problems are solved side by side: enough to fill registers, and for one problem's
/// divisions and roots to wait while the others go on.
inline constexpr int kLanes = 4;

/// One number of each problem.
using Lanes = Eigen::Array<double, kLanes, 1>;

/// x where a > b, else y. Not inline: the compiler would unroll the loop instead of vectorizing it.
Lanes whereGreater(const Lanes& a, const Lanes& b, const Lanes& x, const Lanes& y);

/// One vector of each problem.
struct VectorLanes {
  Lanes x, y, z;
  Eigen::Vector3d operator[](int lane) const { return {x[lane], y[lane], z[lane]}; }
  Lanes squaredNorm() const { return x * x + y * y + z * z; }
};

inline Lanes dot(const VectorLanes& a, const VectorLanes& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline VectorLanes cross(const VectorLanes& a, const VectorLanes& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline VectorLanes normalized(const VectorLanes& a) {
  const Lanes inverse = 1.0 / a.squaredNorm().sqrt();
  return {a.x * inverse, a.y * inverse, a.z * inverse};
}

/// One symmetric matrix of each problem.
struct SymmetricLanes {
  Lanes xx, xy, xz, yy, yz, zz;
  Eigen::Matrix3d operator[](int k) const {
    Eigen::Matrix3d matrix;
    matrix << xx[k], xy[k], xz[k], xy[k], yy[k], yz[k], xz[k], yz[k], zz[k];
    return matrix;
  }
  Lanes trace() const { return xx + yy + zz; }
  /// Sum of the principal minors: second coefficient of the characteristic polynomial.
  Lanes minors() const { return xx * yy - xy * xy + (xx * zz - xz * xz) + (yy * zz - yz * yz); }
  Lanes determinant() const {
    return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  }
  VectorLanes operator*(const VectorLanes& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
            xz * v.x + yz * v.y + zz * v.z};
  }
};

}  // namespace opp
