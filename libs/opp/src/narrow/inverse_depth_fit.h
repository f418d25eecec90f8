// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

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
  /// The axis and two tangents, in its columns.
  const Eigen::Matrix3d& axes() const { return axes_; }
  Ray of(const Eigen::Vector3f& point) const {
    const Eigen::Vector3d x = axes_.transpose() * point.cast<double>();
    const double depth = 1.0 / x[0];
    return {x[1] * depth, x[2] * depth, depth};
  }
  /// Where a ray meets the plane with these coefficients.
  Eigen::Vector3d meet(const Ray& ray, const Eigen::Vector3d& coefficients) const;
  /// A direction along the axis and the two tangents: d·x of a ray's point is, over its inverse
  /// depth, this times the ray's row.
  Eigen::Vector3d along(const Eigen::Vector3d& direction) const {
    return axes_.transpose() * direction;
  }
  /// Turned to the viewpoint.
  Plane planeOf(const Eigen::Vector3d& coefficients) const;
  Eigen::Vector3d coefficientsOf(const Plane& plane) const;
  /// Variance of the normal in its worse direction [rad²].
  double angleVariance(const Eigen::Vector3d& coefficients,
                       const Eigen::Matrix3d& covariance) const;

 private:
  Eigen::Matrix3d axes_;  ///< the axis and two tangents, in its columns
};

/// Rays in one frame, number by number.
struct RayArrays {
  std::vector<double> u, v, inverse_depth;

  using View = Eigen::Map<const Eigen::ArrayXd>;
  static View view(const std::vector<double>& values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
  }
  std::size_t size() const { return u.size(); }
  void add(const RayFrame::Ray& ray) {
    u.push_back(ray.u), v.push_back(ray.v), inverse_depth.push_back(ray.inverse_depth);
  }
  /// coefficients·(1, u, v) of each.
  Eigen::ArrayXd times(const Eigen::Vector3d& coefficients) const {
    return coefficients[0] + coefficients[1] * view(u) + coefficients[2] * view(v);
  }
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
  /// The same for many. \param weights ≥ 0; rays with none do not count.
  void add(const RayArrays& rays, const Eigen::ArrayXd& weights);
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
