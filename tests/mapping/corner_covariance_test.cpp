// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/simulation/depth_camera.h"
#include "opp/mapping/simulation/solids.h"

#include "support/random.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace opp::mapping {
namespace {

constexpr int kScans = 500;
const Eigen::Vector3d kRoom(5.0, 4.0, 2.6);

PointCloud pointsOf(const DepthImage& image) {
  PointCloud cloud;
  cloud.rows = image.camera.height;
  cloud.cols = image.camera.width;
  for (int row = 0; row < cloud.rows; ++row) {
    for (int column = 0; column < cloud.cols; ++column) {
      const double counts = image.counts[image.index(column, row)];
      const double depth = counts > 0.0 ? counts * image.range_unit : std::nan("");
      cloud.points.push_back((depth * image.camera.direction(column, row)).cast<float>());
    }
  }
  return cloud;
}

/// A camera in the room, 1.2 to 3.5 m from `corner`, that looks about there.
Eigen::Isometry3d viewOf(const Eigen::Vector3d& corner, test::Random& random) {
  Eigen::Vector3d eye;
  double distance = 0.0;
  while (distance < 1.2 || distance > 3.5) {
    eye << random.uniform(-1.5, 1.5), random.uniform(-1.2, 1.2), random.uniform(0.6, 2.0);
    distance = (corner - eye).norm();
  }
  const Eigen::Vector3d forward = (corner + random.vector(0.3) - eye).normalized();
  const Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(forward).normalized();
  const Eigen::Vector3d left = Eigen::AngleAxisd(random.uniform(-0.3, 0.3), forward) * level;
  Eigen::Isometry3d room_from_camera = Eigen::Isometry3d::Identity();
  room_from_camera.linear() << forward, left, forward.cross(left);
  room_from_camera.translation() = eye;
  return room_from_camera;
}

/// eᵀ C⁻¹ e of the corner that is found within 0.1 m of the true one; nullopt: there is none.
std::optional<double> normalizedError(const std::vector<Corner>& found,
                                      const Eigen::Vector3d& truth) {
  for (const Corner& corner : found) {
    const Eigen::Vector3d error = corner.position - truth;
    if (error.norm() < 0.1) return error.dot(corner.covariance.ldlt().solve(error));
  }
  return std::nullopt;
}

/// Normalized squared errors of a corner in each of kScans images of an empty room, ascending.
std::vector<double> normalizedErrors() {
  World world;
  const double x = 0.5 * kRoom.x(), y = 0.5 * kRoom.y();
  addRoom(world, {{-x, -y}, {x, -y}, {x, y}, {-x, y}}, 0.0, kRoom.z());
  const RayTracer tracer(world);
  // Noise as in each pixel of a Kinect: disparities, rays, edges, grazing light. Only the file's
  // unit is finer than its millimetre: a disparity is rounded to the same millimetre in all of its
  // pixels, which at 2 m is an error of planes as large as all others together.
  KinectModel model;
  model.range_unit = 1e-4;
  const PinholeCamera camera = PinholeCamera().decimated(2);
  test::Random random(8);
  std::vector<double> errors;
  for (int scan = 0; scan < kScans; ++scan) {
    const Eigen::Vector3d corner((scan & 1) != 0 ? x : -x, (scan & 2) != 0 ? y : -y,
                                 (scan & 4) != 0 ? kRoom.z() : 0.0);
    const Eigen::Isometry3d room_from_camera = viewOf(corner, random);
    const DepthImage image =
        renderKinect(tracer, room_from_camera, camera, model, 1, static_cast<std::uint64_t>(scan));
    const Primitives found = detectFeatures(pointsOf(image), PrimitiveParams()).primitives_in_body;
    const auto error = normalizedError(found.corners, room_from_camera.inverse() * corner);
    if (error) errors.push_back(*error);
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

/// Distribution function of χ² with three degrees of freedom.
double chiSquare3(double x) {
  return std::erf(std::sqrt(0.5 * x)) - std::sqrt(2.0 * x / std::acos(-1.0)) * std::exp(-0.5 * x);
}

TEST(CornerCovariance, NormalizedErrorsInSimulatedDepthFollowChiSquare) {
  const std::vector<double> errors = normalizedErrors();
  const auto count = static_cast<double>(errors.size());
  ASSERT_GE(count, 0.98 * kScans);
  double deviation = 0.0;  // Kolmogorov & Smirnov
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double expected = chiSquare3(errors[i]), rank = static_cast<double>(i);
    deviation = std::max({deviation, expected - rank / count, (rank + 1.0) / count - expected});
  }
  EXPECT_LT(deviation, 1.63 / std::sqrt(count));  // exceeded by chance once in a hundred
  for (const auto& [bound, share] : {std::pair(2.366, 0.5), {6.251, 0.1}, {11.345, 0.01}}) {
    const auto beyond =
        std::distance(std::upper_bound(errors.begin(), errors.end(), bound), errors.end());
    EXPECT_NEAR(static_cast<double>(beyond) / count, share,
                3.0 * std::sqrt(share * (1.0 - share) / count))
        << "beyond " << bound;
  }
}

}  // namespace
}  // namespace opp::mapping
