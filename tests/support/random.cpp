// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/random.h"

namespace opp::test {

double Random::uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine_);
}

double Random::normal(double sigma) {
  return std::normal_distribution<double>(0.0, sigma)(engine_);
}

int Random::integer(int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(engine_);
}

Eigen::Vector3d Random::vector(double half_extent) {
  const double x = uniform(-half_extent, half_extent);
  const double y = uniform(-half_extent, half_extent);
  return {x, y, uniform(-half_extent, half_extent)};
}

Eigen::Vector3d Random::unitVector() {
  Eigen::Vector3d v;
  do {
    const double x = normal();
    const double y = normal();
    v = {x, y, normal()};
  } while (v.norm() < 1e-3);
  return v.normalized();
}

Eigen::Matrix3d Random::rotation() {
  const double w = normal(), x = normal(), y = normal(), z = normal();
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

Eigen::Isometry3d Random::pose(double half_extent) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = rotation();
  result.translation() = vector(half_extent);
  return result;
}

Eigen::Isometry3d Random::motion(double angle, double distance) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::AngleAxisd(uniform(0.0, angle), unitVector()).toRotationMatrix();
  result.translation() = uniform(0.0, distance) * unitVector();
  return result;
}

}  // namespace opp::test
