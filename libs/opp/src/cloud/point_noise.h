// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sampling_params.h"
#include "opp/cloud/sensor_model.h"

#include <Eigen/Core>

#include <algorithm>

namespace opp {

/// Variances along a surface's normal of a raw point measured on it [m²]: the point's squared
/// range, and the viewpoint's distance from the surface's plane, which is the range times the
/// cosine of the incidence angle, tell all without a root.
class PointNoise {
 public:
  /// \param pixel_angle between neighbouring rays [rad]; 0: unknown.
  /// \param scale of the expected variance, as a cloud shows it.
  PointNoise(const SensorModel& sensor, const SamplingParams& params, double pixel_angle,
             double scale = 1.0)
      : constant_(sensor.noise_constant * sensor.noise_constant),
        quadratic_(sensor.noise_quadratic * sensor.noise_quadratic),
        lateral_(params.lateral_noise * params.lateral_noise * pixel_angle * pixel_angle),
        scale_(scale) {}

  /// What the sensor model says: `SensorModel::sigmaAlongNormal` squared.
  double model(double squared_range, double height) const {
    return constant_ + quadratic_ * squared_range * height * height;
  }

  /// With what a ray's direction is off by: it meets a slanted surface nearer or farther (modelled
  /// so by Handa et al., ICRA 2014).
  double expected(double squared_range, double height) const {
    const double squared_height = height * height;
    const double slanted = std::max(0.0, squared_range - squared_height);
    return scale_ * (constant_ + quadratic_ * squared_range * squared_height + lateral_ * slanted);
  }

  /// The same on one plane, which no point on it is nearer to the viewpoint than.
  class OnPlane {
   public:
    double variance(double squared_range) const {
      return constant_ + slope_ * std::max(squared_range, squared_height_);
    }
    Eigen::ArrayXd variances(const Eigen::Ref<const Eigen::ArrayXd>& squared_ranges) const {
      return constant_ + slope_ * squared_ranges.max(squared_height_);
    }

   private:
    friend class PointNoise;
    OnPlane(double constant, double slope, double squared_height)
        : constant_(constant), slope_(slope), squared_height_(squared_height) {}
    double constant_, slope_, squared_height_;
  };
  OnPlane onPlane(double squared_height) const {
    return {scale_ * (constant_ - lateral_ * squared_height),
            scale_ * (quadratic_ * squared_height + lateral_), squared_height};
  }

 private:
  double constant_, quadratic_;
  double lateral_;  ///< variance of a ray's direction [rad²]
  double scale_;
};

}  // namespace opp
