// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/params/field.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace opp {

/// Noise and range of the sensor; every threshold on distances and every weight follows from it.
/// Defaults: Kinect-like structured light, σ(r) = √(a² + (b r²)²) with b = 1.5 mm/m² (disparity
/// noise; Khoshelham & Oude Elberink, Sensors 2012, give 1.4 mm/m²).
struct SensorModel {
  static constexpr std::string_view kSection = "sensor";
  double noise_constant = 0.001;    ///< a
  double noise_quadratic = 0.0015;  ///< b
  double min_range = 0.3;
  double max_range = 6.0;
  /// Neighbouring raw points share part of their error (correlation window of structured light,
  /// quantization, calibration): correlation coefficient ρ of any two of them, at most.
  double noise_correlation = 0.1;
  /// Errors of calibration bend what is flat; they grow as the noise does, with range squared, and
  /// are alike for neighbouring rays, so that no average removes them: σ(r) = c r². Measured as the
  /// spread of means over 24 × 24 pixels about the planes they lie on (median / 0.6745), at 1 to 6
  /// m: 0.0019 for the Xtion of TUM's fr3 sequences and 0.0019 for the camera of MRPT's tests_rgbd,
  /// neither of them calibrated.
  double distortion_quadratic = 0.002;

  /// Standard deviation of a measured range [m].
  double sigma(double range) const {
    const double growing = noise_quadratic * range * range;
    return std::sqrt(noise_constant * noise_constant + growing * growing);
  }

  /// Noise takes points of surfaces near the end of the range beyond it, and the mean of those left
  /// is nearer than their surface: three standard deviations before the end by less than 1 % of
  /// one.
  double farthestSurface() const { return max_range - 3.0 * sigma(max_range); }

  /// Standard deviation of the distortion at a range [m].
  double distortion(double range) const { return distortion_quadratic * range * range; }

  /// Standard deviation of the angle by which distortion tilts a surface [rad]. It is smooth: it
  /// changes by its standard deviation over a tenth of the range, a quarter of what a camera sees.
  double distortionSlope(double range) const { return distortion_quadratic * range / 0.1; }

  /// Variance of the mean of `count` ≥ 1 neighbouring raw points over that of one.
  double meanVariance(double count) const {
    return (1.0 + (count - 1.0) * noise_correlation) / count;
  }

  /// Standard deviation of the mean of `count` ≥ 1 neighbouring raw points of deviation `sigma`.
  double meanSigma(double sigma, double count) const {
    return sigma * std::sqrt(meanVariance(count));
  }

  /// The model for a cloud that shows a correlation of `measured`; < 0: it shows none.
  SensorModel withCorrelation(double measured) const {
    SensorModel model = *this;
    if (measured >= 0.0) model.noise_correlation = std::min(noise_correlation, measured);
    return model;
  }

  /// Standard deviation along a surface's normal of a point measured on it [m]: the part that grows
  /// with range lies along the ray and counts with the cosine of the incidence angle; the constant
  /// part counts in every direction.
  double sigmaAlongNormal(double range, double cos_incidence) const {
    const double along_ray = noise_quadratic * range * range * cos_incidence;
    return std::sqrt(noise_constant * noise_constant + along_ray * along_ray);
  }

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.noise_constant,
      Field{"noise_constant", "m", 1e-6, 1.0, "range noise at any range (standard deviation)"});
    f(p.noise_quadratic,
      Field{"noise_quadratic", "1/m", 0.0, 0.1, "range noise that grows with range squared"});
    f(p.min_range, Field{"min_range", "m", 0.0, 100.0, "nearer returns are ignored"});
    f(p.max_range, Field{"max_range", "m", 0.1, 1000.0, "farther returns are ignored"});
    f(p.noise_correlation,
      Field{"noise_correlation", "", 0.0, 1.0,
            "correlation of the errors of neighbouring raw points; less if a cloud shows less"});
    f(p.distortion_quadratic,
      Field{"distortion_quadratic", "1/m", 0.0, 0.1,
            "distortion (standard deviation) that grows with range squared and bends surfaces"});
  }
};

}  // namespace opp
