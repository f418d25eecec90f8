// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/degenerate_clouds.h"

#include "support/random.h"

#include <functional>

namespace opp::test {
namespace {

constexpr double kSpacing = 0.05;

void add(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, OrientedCloud& cloud) {
  cloud.points.push_back(point.cast<float>());
  cloud.normals.push_back(normal.cast<float>());
  cloud.sigmas.push_back(1e-3F);
  cloud.weights.push_back(1.0F);
  cloud.spacing = kSpacing;
}

/// `count` points, given by their number, with the normal z.
OrientedCloud cloudOf(int count, const std::function<Eigen::Vector3d(int)>& point) {
  OrientedCloud cloud;
  for (int k = 0; k < count; ++k) add(point(k), Eigen::Vector3d::UnitZ(), cloud);
  return cloud;
}

Eigen::Vector3d onLattice(int k, int columns, double z) {
  return {kSpacing * (k % columns), kSpacing * (k / columns), z};
}

}  // namespace

OrientedCloud randomCloud(std::uint64_t seed, int count) {
  Random random(seed);
  OrientedCloud cloud;
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d point = random.vector(1.0);
    add(point, random.unitVector(), cloud);
  }
  return cloud;
}

std::vector<std::pair<std::string, OrientedCloud>> degenerateClouds() {
  std::vector<std::pair<std::string, OrientedCloud>> clouds;
  for (int count = 0; count <= 3; ++count) {
    clouds.emplace_back(std::to_string(count) + " points",
                        cloudOf(count, [](int k) { return onLattice(k, 2, 1.0); }));
  }
  clouds.emplace_back("all equal", cloudOf(500, [](int) { return Eigen::Vector3d(1, 2, 3); }));
  clouds.emplace_back("collinear", cloudOf(500, [](int k) { return onLattice(k, 1, 1.0); }));
  clouds.emplace_back("one plane", cloudOf(900, [](int k) { return onLattice(k, 30, 1.0); }));
  clouds.emplace_back("two parallel planes", cloudOf(1800, [](int k) {
                        return onLattice(k / 2, 30, k % 2 == 0 ? 1.0 : 1.1);
                      }));
  clouds.emplace_back(
      "far away", cloudOf(900, [](int k) {
        return Eigen::Vector3d(onLattice(k, 30, 1e6) + 1e6 * Eigen::Vector3d::UnitX());
      }));
  clouds.emplace_back("huge extent", cloudOf(900, [](int k) {
                        return Eigen::Vector3d(1e6 * onLattice(k, 30, 1.0));
                      }));
  clouds.emplace_back("no spacing", clouds.back().second);
  clouds.back().second.spacing = 0.0;
  clouds.emplace_back("clutter", randomCloud(1, 1000));
  return clouds;
}

}  // namespace opp::test
