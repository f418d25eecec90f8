// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/pixel_rays.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

mrpt::img::TCamera kinect() {
  mrpt::img::TCamera camera;
  camera.ncols = 64;
  camera.nrows = 48;
  camera.setIntrinsicParamsFromValues(50.0, 52.0, 31.5, 23.5);
  return camera;
}

TEST(PixelRays, PinholePixelsGoForwardLeftAndUp) {
  const std::vector<Eigen::Vector3f> rays = pixelRays(kinect());
  ASSERT_EQ(rays.size(), 64U * 48U);
  // Pixel (row 0, col 0) is the upper left: y = 31.5 / 50 to the left, z = 23.5 / 52 up.
  EXPECT_TRUE(rays[0].isApprox(Eigen::Vector3f(1.0F, 0.63F, 23.5F / 52.0F), 1e-6F));
  EXPECT_TRUE(rays[47 * 64 + 63].isApprox(Eigen::Vector3f(1.0F, -0.63F, -23.5F / 52.0F), 1e-6F));
}

TEST(PixelRays, UndistortInvertsBothLensModels) {
  test::Random random(1);
  for (int k = 0; k < 200; ++k) {
    mrpt::img::TCamera camera = kinect();
    if (k % 2 == 0) {
      camera.setDistortionPlumbBob(random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.05),
                                   random.uniform(-0.005, 0.005), random.uniform(-0.005, 0.005),
                                   random.uniform(-0.01, 0.01));
    } else {
      camera.setDistortionKannalaBrandt(random.uniform(-0.05, 0.05), random.uniform(-0.01, 0.01),
                                        random.uniform(-0.002, 0.002), 0.0);
    }
    const Eigen::Vector2d ideal(random.uniform(-0.6, 0.6), random.uniform(-0.45, 0.45));
    const Eigen::Vector2d back = undistort(camera, distort(camera, ideal));
    EXPECT_LT((back - ideal).norm(), 1e-8) << k;  // 1e-10 over a slope of at least 0.1
  }
}

TEST(PixelRays, PixelsBeyondTheLensModelHaveNoRay) {
  mrpt::img::TCamera camera = kinect();
  // r(1 − 2r²) has its maximum 0.27 at r = 0.41: nothing appears farther out.
  camera.setDistortionPlumbBob(-2.0, 0.0, 0.0, 0.0);
  const std::vector<Eigen::Vector3f> rays = pixelRays(camera);
  EXPECT_FALSE(rays[0].allFinite());
  EXPECT_TRUE(rays[24 * 64 + 32].allFinite());
}

TEST(PixelRays, CameraWithoutFocalLengthIsAnError) {
  EXPECT_THROW(pixelRays(mrpt::img::TCamera()), std::runtime_error);
}

TEST(PixelRayCache, KeepsATableForEachCamera) {
  PixelRayCache cache;
  mrpt::img::TCamera other = kinect();
  other.fx(60.0);
  const auto first = cache.raysOf(kinect());
  const auto second = cache.raysOf(other);
  EXPECT_EQ(cache.raysOf(kinect()), first);
  EXPECT_EQ(cache.raysOf(other), second);
  EXPECT_NE(first, second);
}

}  // namespace
}  // namespace opp::mapping
