// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <random>

namespace opp::test {

/// Source of random test inputs; each test makes its own from a written-down seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high);
  double normal(double sigma = 1.0);
  int integer(int low, int high);              ///< both ends included
  Eigen::Vector3d vector(double half_extent);  ///< uniform in a cube
  Eigen::Vector3d unitVector();                ///< uniform on the sphere
  Eigen::Matrix3d rotation();                  ///< uniform on SO(3)
  Eigen::Isometry3d pose(double half_extent);  ///< rotation() and vector()
  /// A small motion: rotation about a random axis by up to `angle` [rad], translation up to
  /// `distance` [m].
  Eigen::Isometry3d motion(double angle, double distance);

 private:
  std::mt19937_64 engine_;
};

}  // namespace opp::test
