// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud/point_noise.h"

#include <Eigen/Core>

namespace opp {

/// Variances of inverse depths on one plane.
class InverseDepthNoise {
 public:
  InverseDepthNoise(const PointNoise& noise, const Eigen::Vector3d& coefficients)
      : squared_length_(coefficients.squaredNorm()), noise_(noise.onPlane(1.0 / squared_length_)) {}

  /// Of one pixel. A point at inverse depth w is (w − q·(1, u, v)) / (w |q|) off the plane with
  /// coefficients q, which is at height 1/|q|.
  double variance(double squared_range, double inverse_depth) const {
    return inverse_depth * inverse_depth * squared_length_ * noise_.variance(squared_range);
  }

  /// Of many pixels.
  Eigen::ArrayXd variances(const Eigen::Ref<const Eigen::ArrayXd>& squared_ranges,
                           const Eigen::Ref<const Eigen::ArrayXd>& inverse_depths) const {
    return inverse_depths.square() * squared_length_ * noise_.variances(squared_ranges);
  }

 private:
  double squared_length_;
  PointNoise::OnPlane noise_;
};

}  // namespace opp
