// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detect_primitives.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp {
namespace {

using Eigen::Vector3d;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A point of one of some surfaces, or what is left of them.
Vector3d pointOf(int shape, test::Random& random) {
  const Vector3d at = random.vector(1.0);
  switch (shape) {
    case 0:
      return {1.0, 2.0, 3.0};
    case 1:
      return {at.x(), 0.5, 1.0};
    case 2:
      return {at.x(), at.y(), 1.0};
    case 3:
      return {at.x(), at.y(), at.z() > 0.0 ? 1.0 : 1.02};
    case 4:
      return at.normalized();
    case 5: {  // faces of a cube
      Eigen::Index axis = 0;
      at.cwiseAbs().maxCoeff(&axis);
      return at / std::abs(at[axis]);
    }
    default:
      return at;
  }
}

/// Up to 600 points; organized or not, with normals or not; some of them not finite; now and then
/// far from the origin, tiny or huge.
PointCloud anyCloud(std::uint64_t seed) {
  test::Random random(seed);
  const auto pick = [&](int count) { return static_cast<int>(random.uniform(0.0, count)); };
  PointCloud cloud;
  const int shape = pick(7);
  const int rows = pick(3) == 0 ? pick(4) : pick(24), cols = pick(25);
  const double scale = pick(4) == 0 ? std::pow(10.0, random.uniform(-6.0, 6.0)) : 1.0;
  const Vector3d offset = pick(4) == 0 ? Vector3d(1e6 * random.unitVector()) : random.vector(2.0);
  const double holes = pick(2) == 0 ? random.uniform(0.0, 1.0) : 0.0;
  const bool normals = pick(2) == 0;
  for (int k = 0; k < rows * cols; ++k) {
    const Vector3d point = offset + scale * pointOf(shape, random);
    cloud.points.push_back(point.cast<float>());
    if (random.uniform(0.0, 1.0) < holes) cloud.points.back()[pick(3)] = kNaN;
    if (!normals) continue;
    const Vector3d normal = pick(3) == 0 ? random.vector(10.0) : Vector3d::UnitZ();
    cloud.normals.push_back(normal.cast<float>());
    if (pick(20) == 0) cloud.normals.back().setConstant(pick(2) == 0 ? 0.0F : kNaN);
  }
  if (pick(2) == 0 && rows > 0 && cols > 0) {
    cloud.rows = rows;
    cloud.cols = cols;
    cloud.columns_wrap = pick(2) == 0;
  }
  if (pick(3) == 0) cloud.viewpoint = offset.cast<float>();
  return cloud;
}

void expectFinite(const Primitives& found) {
  for (const PlanePrimitive& plane : found.planes) {
    ASSERT_TRUE(plane.plane.coefficients().allFinite());
    ASSERT_NEAR(plane.plane.normal().norm(), 1.0, 1e-9);
    ASSERT_TRUE(plane.covariance.allFinite());
    ASSERT_TRUE(std::isfinite(plane.area) && std::isfinite(plane.rms));
  }
  ASSERT_TRUE(found.normal_covariance.allFinite());
  for (const LineSegment& line : found.lines) {
    ASSERT_TRUE(line.start.allFinite() && line.end.allFinite());
  }
  for (const Corner& corner : found.corners) {
    ASSERT_TRUE(corner.position.allFinite() && corner.covariance.allFinite());
    ASSERT_TRUE(corner.cloud_from_corner.allFinite());
  }
}

TEST(ManyClouds, GiveFinitePrimitives) {
  constexpr std::uint64_t kClouds = 10000;
  PrimitiveParams params;
  std::size_t planes = 0;
  for (std::uint64_t seed = 0; seed < kClouds; ++seed) {
    SCOPED_TRACE(seed);
    params.sensor.min_range = seed % 2 == 0 ? 0.0 : 0.3;
    params.sensor.max_range = seed % 2 == 0 ? 1000.0 : 6.0;
    const PointCloud cloud = anyCloud(seed);
    ScanSurface surface = makeScanSurface(cloud, params.sensor, params.sampling);
    const Primitives found = detectPrimitives(cloud, surface, params);
    ASSERT_EQ(found.labels.size(), surface.samples.size());
    for (const int label : found.labels) {
      ASSERT_LT(label, static_cast<int>(found.planes.size()));
    }
    expectFinite(found);
    planes += found.planes.size();
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(planes, kClouds / 10) << "most clouds have none; some must";
}

}  // namespace
}  // namespace opp
