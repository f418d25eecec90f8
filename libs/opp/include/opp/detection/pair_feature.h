// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace opp {

/// Simplified point pair feature of two oriented points (Sommer et al. 2020, Eq. 2), d = x1 − x2.
struct PairFeature {
  float normals = 0.0F;           ///< F1 = n1·n2
  float reference = 0.0F;         ///< F2 = n1·d [m]
  float partner = 0.0F;           ///< F3 = n2·d [m]; ρ of the vote (Eq. 4)
  float squared_distance = 0.0F;  ///< F4² = |d|² [m²]; nothing needs the root
};

inline PairFeature pairFeature(const Eigen::Vector3f& x1, const Eigen::Vector3f& n1,
                               const Eigen::Vector3f& x2, const Eigen::Vector3f& n2) {
  const Eigen::Vector3f d = x1 - x2;
  return {n1.dot(n2), n1.dot(d), n2.dot(d), d.squaredNorm()};
}

/// θ of a vote (Eq. 3): angle in [−π, π] [rad] of the partner's normal in the reference point's
/// tangent plane, not the zero vector there. Off by at most 1.2·10⁻⁵, far less than a bin: the
/// polynomial (Abramowitz & Stegun 4.4.49) vectorizes, which std::atan2 does not, and gives the
/// same bits everywhere.
inline float directionAngle(const Eigen::Vector2f& direction) {
  constexpr float kEighth = 0.785398163F, kQuarter = 1.57079633F;
  const float x = std::abs(direction.x()), y = std::abs(direction.y());
  const float ratio = std::min(x, y) / std::max(x, y), square = ratio * ratio;
  const float series =
      0.9998660F +
      square * (-0.3302995F + square * (0.1801410F + square * (-0.0851330F + square * 0.0208351F)));
  // Reflections at π/4, π/2 and 0 as sign bits: with conditions the loop does not vectorize.
  const float first_quadrant = kEighth + std::copysign(kEighth - ratio * series, y - x);
  const float half_plane = kQuarter - std::copysign(kQuarter - first_quadrant, direction.x());
  return std::copysign(half_plane, direction.y());
}

/// Decides what a pair votes for. Signs of normals play no role.
class PairTest {
 public:
  /// `tolerance`: δ_n [rad], below π/4.
  explicit PairTest(double tolerance)
      : sine_(static_cast<float>(std::sin(tolerance))),
        cosine_(static_cast<float>(std::cos(tolerance))) {}

  /// The planes of the two points are orthogonal (Eq. 1 with tolerance).
  bool orthogonal(const PairFeature& f) const { return std::abs(f.normals) < sine_; }
  /// The two points lie on one plane.
  bool coplanar(const PairFeature& f) const {
    const float reach = f.squared_distance * sine_ * sine_;
    // Without branches, so that loops over pairs vectorize.
    return (std::abs(f.normals) > cosine_) & (f.reference * f.reference < reach) &
           (f.partner * f.partner < reach);
  }

 private:
  float sine_, cosine_;
};

}  // namespace opp
