// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/depth_camera.h"

#include "opp/mapping/simulation/simulator.h"
#include "opp/mapping/simulation/solids.h"

#include "support/first_hit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

/// A wall at x = `distance` that fills the view of a camera at the origin looking along x.
World wallAhead(double distance) {
  World world;
  const double h = 10.0 * distance;
  world.addFace({{distance, -h, -h}, {distance, -h, h}, {distance, h, h}, {distance, h, -h}});
  return world;
}

DepthImage kinectView(const World& world, const KinectModel& model, std::uint64_t seed = 1) {
  return renderKinect(RayTracer(world), Eigen::Isometry3d::Identity(), PinholeCamera(), model, seed,
                      0);
}

double validShare(const DepthImage& image) {
  double valid = 0.0;
  for (const auto count : image.counts) valid += count > 0 ? 1.0 : 0.0;
  return valid / static_cast<double>(image.counts.size());
}

TEST(PinholeCamera, DecimationKeepsTheFieldOfView) {
  const PinholeCamera full;
  const PinholeCamera half = full.decimated(2);
  EXPECT_EQ(half.width, 320);
  EXPECT_EQ(half.height, 240);
  // Outer border of the outermost pixels.
  EXPECT_TRUE(full.direction(-0.5, -0.5).isApprox(half.direction(-0.5, -0.5), 1e-12));
  EXPECT_TRUE(full.direction(639.5, 479.5).isApprox(half.direction(319.5, 239.5), 1e-12));
  EXPECT_THROW(full.decimated(0), std::invalid_argument);
  EXPECT_THROW(full.decimated(481), std::invalid_argument);
}

TEST(IdealCamera, EachPixelOfEachSceneLiesOnItsTruePlane) {
  for (const auto name : builtInScenes()) {
    SCOPED_TRACE(name);
    SimulationOptions options;
    options.sensor = SimulatedSensor::kIdeal;
    options.frames = 3;
    const Simulator simulator(loadScene(std::string(name)), options);
    for (int k = 0; k < simulator.frames(); ++k) {
      const SimulatedFrame frame = simulator.frame(k);
      const auto& image = std::get<DepthImage>(frame.data);
      double worst_exact = 0.0, worst_stored = 0.0;
      for (int row = 0; row < image.camera.height; ++row) {
        for (int column = 0; column < image.camera.width; ++column) {
          const std::size_t i = image.index(column, row);
          if (image.counts[i] == 0) continue;
          const Plane plane = simulator.scene().world.sidePlane(image.sides[i]);
          const Eigen::Vector3d ray = image.camera.direction(column, row);
          const auto residual = [&](double depth) {
            return std::abs(plane.signedDistance(frame.map_from_body * (depth * ray)));
          };
          worst_exact = std::max(worst_exact, residual(image.true_depth[i]));
          worst_stored = std::max(worst_stored, residual(image.counts[i] * image.range_unit));
        }
      }
      EXPECT_LT(worst_exact, 1e-12);
      // Half a unit along the axis is at most 0.5 unit · |ray| along the ray, |ray| ≤ 1.22.
      EXPECT_LT(worst_stored, 1e-6 + 0.61 * image.range_unit);
    }
  }
}

TEST(IdealCamera, SeesTheFirstSurfaceOfEachScene) {
  for (const auto name : builtInScenes()) {
    SCOPED_TRACE(name);
    SimulationOptions options;
    options.sensor = SimulatedSensor::kIdeal;
    options.frames = 2;
    options.decimation = 20;
    const Simulator simulator(loadScene(std::string(name)), options);
    for (int k = 0; k < simulator.frames(); ++k) {
      const SimulatedFrame frame = simulator.frame(k);
      const auto& image = std::get<DepthImage>(frame.data);
      for (int row = 0; row < image.camera.height; ++row) {
        for (int column = 0; column < image.camera.width; ++column) {
          const Eigen::Vector3d ray =
              frame.map_from_body.linear() * image.camera.direction(column, row);
          double nearest_edge = 0.0;
          const double truth = test::firstHit(simulator.scene().world,
                                              frame.map_from_body.translation(), ray, nearest_edge);
          if (nearest_edge < 1e-4) continue;  // float32 cannot tell
          const double depth = image.true_depth[image.index(column, row)];
          if (std::isfinite(truth)) {
            EXPECT_NEAR(depth, truth, 1e-12 * truth);
          } else {
            EXPECT_EQ(depth, 0.0);
          }
        }
      }
    }
  }
}

TEST(IdealCamera, DepthThatDoesNotFitIsLost) {
  const DepthImage image = renderIdeal(RayTracer(wallAhead(14.0)), Eigen::Isometry3d::Identity(),
                                       PinholeCamera().decimated(8), 2e-4);
  EXPECT_EQ(validShare(image), 0.0);  // 65535 · 0.2 mm = 13.1 m
  EXPECT_THROW(
      renderIdeal(RayTracer(wallAhead(1.0)), Eigen::Isometry3d::Identity(), PinholeCamera(), 0.0),
      std::invalid_argument);
}

TEST(Kinect, NoiseOfAFrontalWallGrowsWithRangeSquared) {
  KinectModel model;
  model.lateral_noise = 0.0;
  model.range_unit = 1e-4;  // so that rounding to millimetres does not hide the noise
  for (const double range : {1.03, 2.1, 3.07, 4.95}) {
    const DepthImage image = kinectView(wallAhead(range), model);
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (const auto counts : image.counts) {
      if (counts == 0) continue;
      const double error = counts * model.range_unit - range;
      sum += error, squares += error * error, ++count;
    }
    // Khoshelham & Oude Elberink's 1.43e-3 z²; rounding of one disparity in place of a uniform mix
    // of them changes it by up to a sixth. Mean: half a step would be a bias, a fifth is none.
    const double sigma = 1.43e-3 * range * range;
    EXPECT_NEAR(std::sqrt(squares / count) / sigma, 1.0, 0.17) << range;
    EXPECT_LT(std::abs(sum / count), 0.3 * sigma) << range;
  }
}

TEST(Kinect, HasDepthOnlyFromNearToFar) {
  EXPECT_EQ(validShare(kinectView(wallAhead(0.45), {})), 0.0);
  EXPECT_GT(validShare(kinectView(wallAhead(0.55), {})), 0.99);
  EXPECT_GT(validShare(kinectView(wallAhead(5.7), {})), 0.9);
  EXPECT_EQ(validShare(kinectView(wallAhead(6.5), {})), 0.0);
}

TEST(Kinect, CastsAShadowToTheLeftOfNearThings) {
  World world = wallAhead(2.0);
  Eigen::Isometry3d map_from_box = Eigen::Isometry3d::Identity();
  map_from_box.translation() << 1.005, 0.0, -0.1;
  addBox(world, map_from_box, {0.01, 0.2, 0.2});
  KinectModel model;
  model.lateral_noise = model.edge_dropout = 0.0;
  const DepthImage image = kinectView(world, model);
  int left = 0, right = 0;
  for (int column = 0; column < 640; ++column) {
    if (image.counts[image.index(column, 240)] == 0) ++(column < 320 ? left : right);
  }
  // f · baseline · (1/1 m − 1/2 m) = 21.6 px of wall lack the projector's light.
  EXPECT_NEAR(left, 21.6, 2.0);
  EXPECT_LE(right, 1);
}

TEST(Kinect, LosesGrazingSurfacesAndEdges) {
  World floor;
  floor.addFace({{-9, -9, -0.3}, {9, -9, -0.3}, {9, 9, -0.3}, {-9, 9, -0.3}});
  const DepthImage image = kinectView(floor, {});
  int near_valid = 0, far_valid = 0;
  for (int column = 0; column < 640; ++column) {
    near_valid += image.counts[image.index(column, 475)] > 0 ? 1 : 0;  // 68° of incidence
    far_valid += image.counts[image.index(column, 280)] > 0 ? 1 : 0;   // 86°
  }
  EXPECT_GT(near_valid, 630);
  EXPECT_EQ(far_valid, 0);
}

TEST(Kinect, DrawsTheSameForTheSameSeedAndOtherwiseNot) {
  const World world = wallAhead(2.0);
  EXPECT_EQ(kinectView(world, {}, 4).counts, kinectView(world, {}, 4).counts);
  EXPECT_NE(kinectView(world, {}, 4).counts, kinectView(world, {}, 5).counts);
}

TEST(Kinect, SidesAreGivenExactlyWhereThereIsDepth) {
  SimulationOptions options;
  options.frames = 2;
  const Simulator simulator(loadScene("room"), options);
  const SimulatedFrame frame = simulator.frame(1);
  const auto& image = std::get<DepthImage>(frame.data);
  for (std::size_t i = 0; i < image.counts.size(); ++i) {
    ASSERT_EQ(image.counts[i] > 0, image.sides[i] >= 0);
  }
}

TEST(Kinect, RefusesParametersOutOfRange) {
  KinectModel model;
  model.edge_dropout = 1.5;
  EXPECT_THROW(kinectView(wallAhead(1.0), model), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
