// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace opp {

/// Simplified point pair feature of two oriented points (Sommer et al. 2020, Eq. 2), d = x1 − x2.
struct PairFeature {
  float normals = 0.0F;    ///< F1 = n1·n2
  float reference = 0.0F;  ///< F2 = n1·d [m]
  float partner = 0.0F;    ///< F3 = n2·d [m]; ρ of the vote (Eq. 4)
  float distance = 0.0F;   ///< F4 = |d| [m]
};

inline PairFeature pairFeature(const Eigen::Vector3f& x1, const Eigen::Vector3f& n1,
                               const Eigen::Vector3f& x2, const Eigen::Vector3f& n2) {
  const Eigen::Vector3f d = x1 - x2;
  return {n1.dot(n2), n1.dot(d), n2.dot(d), d.norm()};
}

/// What a pair votes for. Signs of normals play no role.
struct PairTest {
  float sin_tolerance;  ///< sin δ_n
  float cos_tolerance;  ///< cos δ_n

  /// The planes of the two points are orthogonal (Eq. 1 with tolerance).
  bool orthogonal(const PairFeature& f) const { return std::abs(f.normals) < sin_tolerance; }
  /// The two points lie on one plane.
  bool coplanar(const PairFeature& f) const {
    const float reach = f.distance * sin_tolerance;
    return std::abs(f.normals) > cos_tolerance && std::abs(f.reference) < reach &&
           std::abs(f.partner) < reach;
  }
};

}  // namespace opp
