// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/observability.h"

#include "support/random.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

TEST(PointToPlaneJacobian, IsTheDerivativeOfTheResidual) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d arm = random.vector(3.0), normal = random.unitVector();
    const Vector6d step = 1e-7 * Vector6d::Ones();
    const Eigen::Vector3d moved = retract(Eigen::Isometry3d::Identity(), step) * arm;
    EXPECT_NEAR(pointToPlaneJacobian(arm, normal).dot(step), normal.dot(moved - arm), 1e-12);
  }
}

TEST(NormalNoise, IsWhatNoisyNormalsAddToTheHessian) {
  test::Random random(2);
  const Eigen::Vector3d arm(1.0, -2.0, 0.5), normal(0.0, 0.0, 1.0);
  const double sigma = 0.02;
  const int count = 200000;
  Matrix6d mean = Matrix6d::Zero();
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d noisy(random.normal(sigma), random.normal(sigma), 1.0);
    const Vector6d jacobian = pointToPlaneJacobian(arm, noisy);
    mean += jacobian * jacobian.transpose() / count;
  }
  const Vector6d exact = pointToPlaneJacobian(arm, normal);
  NormalNoise noise;
  noise.add(1.0, arm, 1.0, exact);
  const Matrix6d expected = exact * exact.transpose() + sigma * sigma * noise.sum();
  // Largest term 2·arm·σ/√count of the mixed products = 2e-4, times 4 for 36 entries.
  EXPECT_LT((mean - expected).cwiseAbs().maxCoeff(), 8e-4);
  EXPECT_NEAR(expected(3, 3), sigma * sigma, 1e-12);
}

TEST(NormalNoise, AddsUpOverWeightedResiduals) {
  test::Random random(4);
  NormalNoise both;
  Matrix6d expected = Matrix6d::Zero();
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d arm = random.vector(3.0);
    const Vector6d jacobian = pointToPlaneJacobian(arm, random.unitVector());
    const double weight = random.uniform(0.1, 2.0);
    NormalNoise one;
    one.add(1.0, arm, 1.0, jacobian);
    expected += weight * one.sum();
    const double scale = random.uniform(0.5, 2.0);
    both.add(weight / (scale * scale), scale * arm, scale, scale * jacobian);
  }
  EXPECT_TRUE(both.sum().isApprox(expected, 1e-12));
}

TEST(WithoutNoise, LeavesWhatIsRealAndNothingNegative) {
  test::Random random(3);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Matrix3d turn = random.rotation();
    Matrix6d hessian = Matrix6d::Zero(), noise = Matrix6d::Zero();
    const Eigen::Vector3d eigenvalues(100.0, 1.0, 1.0);
    hessian.bottomRightCorner<3, 3>() = turn * eigenvalues.asDiagonal() * turn.transpose();
    noise.bottomRightCorner<3, 3>() =
        turn * Eigen::Vector3d(0.0, 2.0, 0.5).asDiagonal() * turn.transpose();
    const Matrix6d real = withoutNoise(hessian, noise, 2.0);
    const Eigen::Matrix3d expected =
        turn * Eigen::Vector3d(100.0, 0.0, 0.5).asDiagonal() * turn.transpose();
    EXPECT_TRUE((real.bottomRightCorner<3, 3>()).isApprox(expected, 1e-9));
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(real, Eigen::EigenvaluesOnly);
    EXPECT_GE(eigen.eigenvalues()[0], -1e-9);
  }
  EXPECT_TRUE(withoutNoise(Matrix6d::Zero(), Matrix6d::Zero(), 1.0).isZero());
}

TEST(CovarianceOf, IsTheInverseAndFiniteWithoutInformation) {
  Matrix6d information = Matrix6d::Zero();
  information(3, 3) = 1e4;
  const Matrix6d covariance = covarianceOf(information);
  EXPECT_NEAR(covariance(3, 3), 1e-4, 1e-9);
  EXPECT_NEAR(covariance(4, 4), 1e4, 1e-6);
}

}  // namespace
}  // namespace opp::mapping
