// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/observability.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace opp::mapping {

Matrix6d NormalNoise::sum() const {
  // J = A·n with A = ([arm]×; I), so Cov(J) = A·Cov(n)·Aᵀ and Cov(n) = σ²(I − n·nᵀ).
  Eigen::Matrix3d cross;
  cross << 0.0, -arms_.z(), arms_.y(),  //
      arms_.z(), 0.0, -arms_.x(),       //
      -arms_.y(), arms_.x(), 0.0;
  Matrix6d all;
  all << squared_arms_.trace() * Eigen::Matrix3d::Identity() - squared_arms_, cross,
      cross.transpose(), squared_scales_ * Eigen::Matrix3d::Identity();
  return all - seen_;
}

Matrix6d withoutNoise(const Matrix6d& hessian, const Matrix6d& noise, double range) {
  Vector6d units;
  units << Eigen::Vector3d::Constant(1.0 / range), Eigen::Vector3d::Ones();
  const Matrix6d scaled = units.asDiagonal() * (hessian - noise) * units.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scaled);
  const Matrix6d positive = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
                            eigen.eigenvectors().transpose();
  return units.cwiseInverse().asDiagonal() * positive * units.cwiseInverse().asDiagonal();
}

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d result;
  result << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return result;
}

Matrix6d movedBy(const Eigen::Vector3d& offset) {
  Matrix6d moved = Matrix6d::Identity();
  moved.bottomLeftCorner<3, 3>() = crossMatrix(-offset);
  return moved;
}

double largestVariance(const Eigen::Matrix3d& covariance) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
      .eigenvalues()[2];
}

Matrix6d inverse(const Matrix6d& matrix) { return matrix.ldlt().solve(Matrix6d::Identity()); }

Matrix6d covarianceOf(const Matrix6d& information) {
  constexpr double kLeast = 1e-4;
  return inverse(information + kLeast * Matrix6d::Identity());
}

}  // namespace opp::mapping
