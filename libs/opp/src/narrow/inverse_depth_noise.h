// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud/point_noise.h"

#include <Eigen/Core>

#include <algorithm>

namespace opp {

/// Variances of inverse depths on one plane.
class InverseDepthNoise {
 public:
  InverseDepthNoise(const PointNoise& noise, const Eigen::Vector3d& coefficients)
      : noise_(noise),
        squared_length_(coefficients.squaredNorm()),
        squared_height_(1.0 / squared_length_) {}

  /// Of one pixel. A point at inverse depth w is (w − q·(1, u, v)) / (w |q|) off the plane with
  /// coefficients q, which is at height 1/|q|.
  double variance(double squared_range, double inverse_depth) const {
    const double height = std::min(squared_range, squared_height_);
    return inverse_depth * inverse_depth * squared_length_ *
           noise_.expectedAt(squared_range, height);
  }

 private:
  PointNoise noise_;
  double squared_length_, squared_height_;
};

}  // namespace opp
