// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include <Eigen/Core>

namespace opp {

/// Rays about the viewpoint by where they pierce a plane one unit along an axis. There, a surface's
/// inverse depth is q·(1, u, v) if it is a plane: linear, and free of the bias that noise along
/// slanted rays gives a fit of points.
class RayFrame {
 public:
  explicit RayFrame(const Eigen::Vector3d& axis);

  struct Ray {
    double u = 0.0, v = 0.0;
    double inverse_depth = 0.0;  ///< along the axis [1/m]
    Eigen::Vector3d row() const { return {1.0, u, v}; }
  };
  Ray of(const Eigen::Vector3f& point) const;
  /// Where a ray meets the plane with these coefficients.
  Eigen::Vector3d meet(const Ray& ray, const Eigen::Vector3d& coefficients) const;
  /// Turned to the viewpoint.
  Plane planeOf(const Eigen::Vector3d& coefficients) const;
  Eigen::Vector3d coefficientsOf(const Plane& plane) const;
  /// Variance of the normal in its worse direction [rad²].
  double angleVariance(const Eigen::Vector3d& coefficients,
                       const Eigen::Matrix3d& covariance) const;

 private:
  Eigen::Matrix3d axes_;  ///< the axis and two tangents, in its columns
};

/// Weighted least squares.
class InverseDepthFit {
 public:
  void add(const RayFrame::Ray& ray, double weight) {
    const double wu = weight * ray.u, wv = weight * ray.v, w = ray.inverse_depth;
    n_ += weight, u_ += wu, v_ += wv;
    uu_ += wu * ray.u, uv_ += wu * ray.v, vv_ += wv * ray.v;
    w_ += weight * w, uw_ += wu * w, vw_ += wv * w, ww_ += weight * w * w;
    count_ += 1.0;
  }
  /// False if the rays do not fix a plane.
  bool solve();
  double count() const { return count_; }
  const Eigen::Vector3d& coefficients() const { return coefficients_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }
  /// Σ weight × residual² of the solution.
  double misfit() const;

 private:
  // Number by number: vectors would be stored in parts and loaded whole, which stalls the loop.
  double n_ = 0.0, u_ = 0.0, v_ = 0.0, uu_ = 0.0, uv_ = 0.0, vv_ = 0.0;  ///< Σ weight × ...
  double w_ = 0.0, uw_ = 0.0, vw_ = 0.0, ww_ = 0.0;                      ///< w: inverse depth
  double count_ = 0.0;
  Eigen::Vector3d coefficients_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace opp
