// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/inverse_depth_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>

namespace opp {

RayFrame::RayFrame(const Eigen::Vector3d& axis) {
  axes_.col(0) = axis.normalized();
  axes_.rightCols<2>() = tangentBasis(axes_.col(0));
}

Eigen::Vector3d RayFrame::meet(const Ray& ray, const Eigen::Vector3d& coefficients) const {
  return axes_ * ray.row() / coefficients.dot(ray.row());
}

Plane RayFrame::planeOf(const Eigen::Vector3d& coefficients) const {
  // q·x = 1 on the plane.
  return Plane::fromCoefficients(-(axes_ * coefficients), 1.0);
}

Eigen::Vector3d RayFrame::coefficientsOf(const Plane& plane) const {
  return axes_.transpose() * plane.normal() / -plane.d();
}

double RayFrame::angleVariance(const Eigen::Vector3d& coefficients,
                               const Eigen::Matrix3d& covariance) const {
  const Eigen::Vector3d normal = coefficients.normalized();
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(normal);
  const Eigen::Matrix2d angles =
      tangents.transpose() * covariance * tangents / coefficients.squaredNorm();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(angles, Eigen::EigenvaluesOnly)
      .eigenvalues()[1];
}

void InverseDepthFit::add(const RayArrays& rays, const Eigen::ArrayXd& weights) {
  const auto u = RayArrays::view(rays.u), v = RayArrays::view(rays.v);
  const auto w = RayArrays::view(rays.inverse_depth);
  const Eigen::ArrayXd wu = weights * u, wv = weights * v, ww = weights * w;
  n_ += weights.sum(), u_ += wu.sum(), v_ += wv.sum();
  uu_ += (wu * u).sum(), uv_ += (wu * v).sum(), vv_ += (wv * v).sum();
  w_ += ww.sum(), uw_ += (ww * u).sum(), vw_ += (ww * v).sum(), ww_ += (ww * w).sum();
  count_ += static_cast<double>((weights > 0.0).count());
}

bool InverseDepthFit::solve() {
  Eigen::Matrix3d known;
  known << n_, u_, v_, u_, uu_, uv_, v_, uv_, vv_;
  covariance_ = known.inverse();
  coefficients_ = covariance_ * Eigen::Vector3d(w_, uw_, vw_);
  return coefficients_.allFinite() && covariance_.allFinite();
}

double InverseDepthFit::misfit() const {
  return std::max(0.0, ww_ - coefficients_.dot(Eigen::Vector3d(w_, uw_, vw_)));
}

}  // namespace opp
