// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace opp {

/// Second moments of points of a plane, in its coordinates, and the rectangle that has the same.
class PlanarSpread {
 public:
  /// Number by number: vectors would be stored in parts and loaded whole, which stalls loops.
  void add(double x, double y) {
    count_ += 1.0;
    sum_[0] += x, sum_[1] += y;
    squares_(0, 0) += x * x, squares_(1, 0) += y * x, squares_(1, 1) += y * y;
  }
  double count() const { return count_; }
  Eigen::Vector2d mean() const { return sum_ / count_; }
  /// Of the rectangle, the shorter side first.
  Eigen::Vector2d widths() const { return widthsOf(solve(Eigen::EigenvaluesOnly).eigenvalues()); }

  /// The rectangle's sides and their directions.
  struct Axes {
    Eigen::Vector2d widths;
    Eigen::Matrix2d directions;  ///< in its columns
  };
  Axes axes() const {
    const auto solver = solve(Eigen::ComputeEigenvectors);
    return {widthsOf(solver.eigenvalues()), solver.eigenvectors()};
  }

  /// A rectangle of width w has variance w²/12.
  static Eigen::Vector2d widthsOf(const Eigen::Vector2d& variances) {
    return (12.0 * variances.cwiseMax(0.0)).cwiseSqrt();
  }

 private:
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solve(int options) const {
    const Eigen::Vector2d middle = mean();
    // Reads the lower triangle.
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
        squares_ / count_ - middle * middle.transpose(), options);
  }

  double count_ = 0.0;
  Eigen::Vector2d sum_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares_ = Eigen::Matrix2d::Zero();  ///< lower triangle
};

}  // namespace opp
