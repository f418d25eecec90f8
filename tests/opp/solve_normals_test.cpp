// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/refinement/solve_normals.h"

#include "opp/geometry/constants.h"
#include "opp/geometry/point_moments.h"

#include "support/random.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace opp {
namespace {

/// Scatter of points on a plane with normal n, 100 m² of extent, plus an isotropic noise floor.
Eigen::Matrix3d planarScatter(const Eigen::Vector3d& n, double noise) {
  return 100.0 * (Eigen::Matrix3d::Identity() - n * n.transpose()) +
         noise * Eigen::Matrix3d::Identity();
}

/// Five normals: a frame of three, and two free ones; soft edges 3–0 and 3–4.
NormalProblem mixedProblem(const std::vector<Eigen::Vector3d>& normals) {
  NormalProblem problem;
  for (const Eigen::Vector3d& n : normals) problem.scatters.push_back(planarScatter(n, 0.01));
  problem.frames = {{0, 1, 2}};
  problem.soft_edges = {{{0, 3}, 30.0}, {{3, 4}, 20.0}};
  return problem;
}

std::vector<Eigen::Vector3d> randomNormals(test::Random& random) {
  const Eigen::Matrix3d frame = random.rotation();
  return {frame.col(0), frame.col(1), -frame.col(2), random.unitVector(), random.unitVector()};
}

TEST(NormalProblem, GradientIsTheDerivativeOfTheEnergy) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    const NormalProblem problem = mixedProblem(randomNormals(random));
    const std::vector<Eigen::Vector3d> normals = randomNormals(random);
    const NormalSystem system = linearize(problem, normals);
    ASSERT_EQ(system.gradient.size(), 3 + 2 + 2);
    for (Eigen::Index i = 0; i < system.gradient.size(); ++i) {
      const double h = 1e-5;  // central difference: error h²·E''' ≈ 1e-10 · 1e3, rounding 1e-9
      const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(system.gradient.size(), i);
      const double slope = (energy(problem, retract(problem, normals, step)) -
                            energy(problem, retract(problem, normals, -step))) /
                           (2.0 * h);
      EXPECT_NEAR(2.0 * system.gradient[i], slope, 1e-5);
    }
  }
}

TEST(NormalProblem, InformationIsTheHessianWhereTheResidualsVanish) {
  test::Random random(2);
  for (int k = 0; k < 50; ++k) {
    const std::vector<Eigen::Vector3d> normals = randomNormals(random);
    NormalProblem problem = mixedProblem(normals);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      problem.scatters[i] = planarScatter(normals[i], 0.0);
    }
    problem.soft_edges.clear();
    const NormalSystem system = linearize(problem, normals);
    const Eigen::VectorXd step = 1e-5 * Eigen::VectorXd::Random(system.gradient.size());
    // Third order in the step: relative 1e-5.
    EXPECT_NEAR(energy(problem, retract(problem, normals, step)),
                step.dot(system.information * step), 1e-4 * step.dot(system.information * step));
  }
}

TEST(SolveNormals, FramesAreOrthogonalToTheLastDigits) {
  test::Random random(3);
  for (int k = 0; k < 50; ++k) {
    std::vector<Eigen::Vector3d> normals = randomNormals(random);
    normals[4] = normals[3].unitOrthogonal();
    for (Eigen::Vector3d& n : normals) n = (n + random.vector(0.1)).normalized();
    NormalProblem problem = mixedProblem(normals);
    problem.frames = {{0, 1, 2}, {3, 4}};
    const NormalSolution solution = solveNormals(problem, normals);
    EXPECT_TRUE(solution.converged);
    const auto& n = solution.normals;
    for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}, {3, 4}}) {
      EXPECT_NEAR(n[static_cast<std::size_t>(a)].dot(n[static_cast<std::size_t>(b)]), 0.0, 1e-14);
    }
  }
}

TEST(SolveNormals, RecoversExactNormalsFromAnglesOfTenDegrees) {
  test::Random random(4);
  for (int k = 0; k < 50; ++k) {
    const std::vector<Eigen::Vector3d> truth = randomNormals(random);
    NormalProblem problem = mixedProblem(truth);
    problem.soft_edges.clear();
    std::vector<Eigen::Vector3d> initial = truth;
    for (Eigen::Vector3d& n : initial) {
      n = Eigen::AngleAxisd(0.17, random.unitVector()) * n;
    }
    const NormalSolution solution = solveNormals(problem, initial);
    EXPECT_TRUE(solution.converged);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_LT((solution.normals[i] - truth[i]).norm(), 1e-9);  // solver's tolerance 1e-12
    }
  }
}

TEST(SolveNormals, SoftEdgeBalancesDataAndOrthogonality) {
  // Two normals 80° apart with information 100 each and λ = 100: each gives way by x where
  // 100 x = 100·cos(80° + 2x)·sin(80° + 2x).
  const double angle = 80.0 * kPi / 180.0;
  const std::vector<Eigen::Vector3d> normals = {Eigen::Vector3d::UnitX(),
                                                {std::cos(angle), std::sin(angle), 0.0}};
  NormalProblem problem;
  for (const Eigen::Vector3d& n : normals) problem.scatters.push_back(planarScatter(n, 0.0));
  problem.soft_edges = {{{0, 1}, 100.0}};
  const NormalSolution solution = solveNormals(problem, normals);
  const double final_angle = std::acos(solution.normals[0].dot(solution.normals[1]));
  const double x = 0.5 * (final_angle - angle);
  // Data term sin x cos x.
  EXPECT_NEAR(std::sin(x) * std::cos(x), std::cos(final_angle) * std::sin(final_angle), 1e-9);
  EXPECT_GT(x, 0.05);
}

TEST(SolveNormals, CovarianceOfAFreeNormalIsThatOfThePlaneFit) {
  test::Random random(5);
  for (int k = 0; k < 50; ++k) {
    PointMoments moments;
    const Eigen::Vector3d n = random.unitVector();
    const Plane plane = Plane::fromPointNormal(random.vector(1.0), n);
    for (int i = 0; i < 100; ++i) moments.add(plane.project(random.vector(2.0)), 1e4);
    NormalProblem problem;
    problem.scatters = {moments.scatter()};
    const NormalSolution solution = solveNormals(problem, {n});
    const Eigen::Matrix2d expected = planeCovariance(plane, moments).topLeftCorner<2, 2>();
    // The prior of 1 rad⁻² beside 1e6 rad⁻² of data.
    const Eigen::MatrixXd covariance = normalCovariance(problem, solution.normals);
    EXPECT_LT((covariance - expected).norm(), 1e-4 * expected.norm());
  }
}

TEST(SolveNormals, UnobservedNormalsStayAndHaveAVarianceOfOne) {
  NormalProblem problem;
  problem.scatters = {Eigen::Matrix3d::Zero()};
  const NormalSolution solution = solveNormals(problem, {Eigen::Vector3d::UnitX()});
  EXPECT_TRUE(solution.converged);
  EXPECT_EQ(solution.normals[0], Eigen::Vector3d::UnitX());
  EXPECT_TRUE(normalCovariance(problem, solution.normals).isApprox(Eigen::Matrix2d::Identity()));
  EXPECT_TRUE(solveNormals(NormalProblem(), {}).normals.empty());
}

TEST(SolveNormals, RejectsProblemsThatDoNotFitTogether) {
  NormalProblem problem;
  problem.scatters.assign(2, Eigen::Matrix3d::Identity());
  const std::vector<Eigen::Vector3d> two(2, Eigen::Vector3d::UnitX());
  EXPECT_THROW(solveNormals(problem, {}), std::invalid_argument);
  problem.frames = {{0}};
  EXPECT_THROW(solveNormals(problem, two), std::invalid_argument);
  problem.frames = {{0, 2}};
  EXPECT_THROW(solveNormals(problem, two), std::invalid_argument);
  problem.frames = {{0, 0}};
  EXPECT_THROW(solveNormals(problem, two), std::invalid_argument);
  problem.frames.clear();
  problem.soft_edges = {{{0, -1}, 1.0}};
  EXPECT_THROW(solveNormals(problem, two), std::invalid_argument);
}

}  // namespace
}  // namespace opp
