// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/point_moments.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace opp {

void PointMoments::add(const Eigen::Vector3d& point, double weight) {
  if (!(weight > 0.0)) return;
  // Number by number: vectors would be stored in parts and loaded whole, which stalls loops.
  const double x = point[0] - mean_[0], y = point[1] - mean_[1], z = point[2] - mean_[2];
  weight_ += weight;
  const double part = weight / weight_;
  mean_[0] += part * x, mean_[1] += part * y, mean_[2] += part * z;
  const double wx = weight * x, wy = weight * y, wz = weight * z;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double rest = point[k] - mean_[k];
    scatter_(0, k) += wx * rest, scatter_(1, k) += wy * rest, scatter_(2, k) += wz * rest;
  }
}

void PointMoments::merge(const PointMoments& other) {
  if (other.empty()) return;
  const Eigen::Vector3d delta = other.mean_ - mean_;
  const double total = weight_ + other.weight_;
  scatter_ += other.scatter_ + (weight_ * other.weight_ / total) * delta * delta.transpose();
  mean_ += (other.weight_ / total) * delta;
  weight_ = total;
}

void PointMoments::scaleWeights(double factor) {
  weight_ *= factor;
  scatter_ *= factor;
}

double PointMoments::squaredError(const Plane& plane) const {
  const double offset = plane.signedDistance(mean_);
  return weight_ * offset * offset + plane.normal().dot(scatter_ * plane.normal());
}

Eigen::Matrix4d PointMoments::homogeneous() const {
  const Eigen::Matrix4d factors = factor();
  return factors * factors.transpose();
}

Eigen::Matrix4d PointMoments::factor() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 *
                                                             (scatter_ + scatter_.transpose()));
  Eigen::Matrix4d factor = Eigen::Matrix4d::Zero();
  for (int k = 0; k < 3; ++k) {
    factor.block<3, 1>(0, k) =
        std::sqrt(std::max(0.0, eigen.eigenvalues()[k])) * eigen.eigenvectors().col(k);
  }
  factor.col(3) = std::sqrt(weight_) * mean_.homogeneous();
  return factor;
}

Plane PointMoments::fitPlane(const Eigen::Vector3d& viewpoint) const {
  if (empty()) throw std::invalid_argument("no plane fits an empty set of points");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter_);
  const Plane plane = Plane::fromPointNormal(mean_, eigen.eigenvectors().col(0));
  return plane.signedDistance(viewpoint) < 0.0 ? plane.flipped() : plane;
}

Eigen::Vector3d PointMoments::variances() const {
  if (empty()) return Eigen::Vector3d::Zero();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter_ / weight_,
                                                             Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().cwiseMax(0.0);
}

PointMoments transformed(const Eigen::Isometry3d& b_from_a, const PointMoments& moments_in_a) {
  PointMoments result;
  result.weight_ = moments_in_a.weight_;
  if (moments_in_a.empty()) return result;
  result.mean_ = b_from_a * moments_in_a.mean_;
  result.scatter_ = b_from_a.linear() * moments_in_a.scatter_ * b_from_a.linear().transpose();
  return result;
}

Eigen::Matrix3d planeCovariance(const Plane& plane, const PointMoments& moments,
                                double max_variance) {
  // Residual of a point: n·x + d, derivative (t1·x, t2·x, 1). Its normal matrix is split at the
  // mean, where offset and angles decouple; this keeps far-away planes well conditioned.
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(plane.normal());
  const Eigen::Matrix2d angle_information = tangents.transpose() * moments.scatter() * tangents;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(angle_information);
  const auto variance = [max_variance](double information) {
    return information * max_variance > 1.0 ? 1.0 / information : max_variance;
  };
  const Eigen::Vector2d variances(variance(eigen.eigenvalues()[0]),
                                  variance(eigen.eigenvalues()[1]));
  const Eigen::Matrix2d angles =
      eigen.eigenvectors() * variances.asDiagonal() * eigen.eigenvectors().transpose();
  const Eigen::Vector2d lever = tangents.transpose() * moments.mean();
  Eigen::Matrix3d covariance;
  covariance.topLeftCorner<2, 2>() = angles;
  covariance.topRightCorner<2, 1>() = -angles * lever;
  covariance.bottomLeftCorner<1, 2>() = -(angles * lever).transpose();
  covariance(2, 2) = variance(moments.weight()) + lever.dot(angles * lever);
  return covariance;
}

}  // namespace opp
