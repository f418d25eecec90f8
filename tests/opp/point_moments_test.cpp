// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/point_moments.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <vector>

namespace opp {
namespace {

TEST(PointMoments, SquaredErrorEqualsTheSumOverThePoints) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    const Plane plane = Plane::fromPointNormal(random.vector(3.0), random.unitVector());
    PointMoments first, second;
    double sum = 0.0;
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d x = random.vector(3.0);
      const double weight = random.uniform(0.1, 2.0);
      (i % 3 == 0 ? first : second).add(x, weight);
      sum += weight * plane.signedDistance(x) * plane.signedDistance(x);
    }
    first.merge(second);
    EXPECT_NEAR(first.squaredError(plane), sum, 1e-10 * sum);
    const Eigen::Vector4d pi = plane.coefficients();
    EXPECT_NEAR(pi.dot(first.homogeneous() * pi), sum, 1e-10 * sum);
    EXPECT_NEAR((first.factor().transpose() * pi).squaredNorm(), sum, 1e-10 * sum);
    const Eigen::Isometry3d b_from_a = random.pose(4.0);
    EXPECT_NEAR(transformed(b_from_a, first).squaredError(transformed(b_from_a, plane)), sum,
                1e-10 * sum);
  }
}

TEST(PointMoments, FitsTheExactPlaneFarFromTheOrigin) {
  test::Random random(2);
  // 1 km away; rounding of coordinates is 1e-13 m, so 1e-9 leaves room for the eigen solver.
  const Plane truth = Plane::fromPointNormal({1000.0, -500.0, 20.0}, random.unitVector());
  PointMoments moments;
  for (int i = 0; i < 100; ++i) {
    moments.add(truth.project(Eigen::Vector3d(1000.0, -500.0, 20.0) + random.vector(1.0)));
  }
  const Plane fit = moments.fitPlane(Eigen::Vector3d(1000.0, -500.0, 20.0) + truth.normal());
  EXPECT_LT(angleBetween(fit, truth), 1e-9);
  EXPECT_NEAR(moments.variances()[0], 0.0, 1e-12);
}

TEST(PointMoments, EmptySetHasNoPlane) {
  const PointMoments empty;
  EXPECT_THROW(empty.fitPlane(Eigen::Vector3d::Zero()), std::invalid_argument);
  EXPECT_EQ(empty.variances(), Eigen::Vector3d::Zero());
  EXPECT_TRUE(transformed(Eigen::Isometry3d::Identity(), empty).empty());
}

TEST(PlaneCovariance, PredictsTheScatterOfFits) {
  // 1,000 fits to 60 noisy points: the mean normalized squared error is 3 ± 3·√(6/1000) = 3 ± 0.23.
  test::Random random(3);
  const Plane truth = Plane::fromPointNormal({0.5, 2.0, 1.0}, random.unitVector());
  const double sigma = 0.01;
  double normalized_error = 0.0;
  for (int k = 0; k < 1000; ++k) {
    PointMoments moments;
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d x = truth.project(Eigen::Vector3d(0.5, 2.0, 1.0) + random.vector(1.0));
      moments.add(x + random.normal(sigma) * truth.normal(), 1.0 / (sigma * sigma));
    }
    const Plane fit = moments.fitPlane(Eigen::Vector3d(0.5, 2.0, 1.0) + truth.normal());
    const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(fit.normal());
    Eigen::Vector3d error;
    error << tangents.transpose() * truth.normal(), truth.d() - fit.d();
    normalized_error += error.dot(planeCovariance(fit, moments).inverse() * error);
  }
  EXPECT_NEAR(normalized_error / 1000.0, 3.0, 0.23);
}

}  // namespace
}  // namespace opp
