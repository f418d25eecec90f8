// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/simulator.h"

#include "opp/cloud/sensor_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace opp::mapping {
namespace {

const DepthImage& imageOf(const SimulatedFrame& frame) { return std::get<DepthImage>(frame.data); }

Simulator simulatorOf(const std::string& scene, const SimulationOptions& options) {
  return Simulator(loadScene(scene), options);
}

TEST(Simulator, AFrameDependsOnItsNumberAndNotOnTheOrder) {
  SimulationOptions options;
  options.frames = 5;
  options.decimation = 4;
  const Simulator simulator = simulatorOf("room", options);
  const SimulatedFrame later = simulator.frame(3);
  simulator.frame(0);
  EXPECT_EQ(imageOf(later).counts, imageOf(simulator.frame(3)).counts);
  EXPECT_NE(imageOf(later).counts, imageOf(simulator.frame(4)).counts);
  options.seed = 2;
  EXPECT_NE(imageOf(later).counts, imageOf(simulatorOf("room", options).frame(3)).counts);
}

TEST(Simulator, FramesSpreadEvenlyOverTheWay) {
  SimulationOptions options;
  options.frames = 11;
  const Simulator simulator = simulatorOf("blank", options);  // an open path
  for (int i = 1; i < simulator.frames(); ++i) {
    EXPECT_NEAR(simulator.timestamp(i) - simulator.timestamp(i - 1), simulator.duration() / 10.0,
                2e-6);  // whole microseconds
  }
  options.rate = 10.0;
  EXPECT_NEAR(simulatorOf("blank", options).duration(), 1.0, 1e-12);
  options.frames = 0;
  EXPECT_NEAR(simulatorOf("blank", options).duration(), simulator.duration(), 0.1);
}

TEST(Simulator, PassesFollowEachOtherOnClosedWaysOnly) {
  SimulationOptions options;
  options.frames = 20;
  options.passes = 2;
  options.drop_rate = 0.0;
  const Simulator simulator = simulatorOf("room", options);
  // The hand's unrest differs from pass to pass, at most by its amplitude.
  EXPECT_LT(
      (simulator.mapFromBody(3).translation() - simulator.mapFromBody(13).translation()).norm(),
      0.02);
  EXPECT_THROW(simulatorOf("blank", options), std::invalid_argument);
}

TEST(Simulator, LosesFramesAtTheStatedRate) {
  SimulationOptions options;
  options.frames = 2000;
  options.drop_rate = 0.3;
  const Simulator simulator = simulatorOf("room", options);
  // Four standard deviations of a binomial count: 4·√(2000·0.3·0.7) = 82.
  EXPECT_NEAR(simulator.frames(), 1400, 82);
  EXPECT_EQ(simulator.timestamp(0), options.start_time);
  for (int i = 1; i < simulator.frames(); ++i) {
    ASSERT_GT(simulator.timestamp(i), simulator.timestamp(i - 1));
  }
}

TEST(Simulator, KidnappingJumpsOnceWhileTheClockRunsOn) {
  SimulationOptions options;
  options.frames = 200;
  options.kidnap = {{0.4, 0.6}};
  const Simulator simulator = simulatorOf("apartment", options);
  int jumps = 0;
  for (int i = 1; i < simulator.frames(); ++i) {
    const double step =
        (simulator.mapFromBody(i).translation() - simulator.mapFromBody(i - 1).translation())
            .norm();
    if (simulator.kidnappedBefore(i)) {
      ++jumps;
      EXPECT_GT(step, 1.0);
    } else {
      EXPECT_LT(step, 0.3);
    }
    EXPECT_NEAR(simulator.timestamp(i) - simulator.timestamp(i - 1),
                simulator.timestamp(1) - simulator.timestamp(0), 2e-6);
  }
  EXPECT_EQ(jumps, 1);
}

TEST(Simulator, ARobotStaysLevelAndItsSensorKeepsItsMounting) {
  SimulationOptions options;
  options.frames = 10;
  options.decimation = 8;
  options.planar = true;
  options.sensor = SimulatedSensor::kIdeal;
  options.body_from_sensor.translation() << 0.1, 0.0, 1.3;
  const Simulator simulator = simulatorOf("office", options);
  for (int i = 0; i < simulator.frames(); ++i) {
    const Eigen::Isometry3d pose = simulator.mapFromBody(i);
    EXPECT_NEAR(pose.translation().z(), 0.0, 1e-12);
    EXPECT_NEAR(pose.linear()(2, 2), 1.0, 1e-12);
  }
  // Seen from 1.3 m above the floor, no pixel lies below it.
  const SimulatedFrame frame = simulator.frame(4);
  const DepthImage& image = imageOf(frame);
  for (int row = 0; row < image.camera.height; ++row) {
    for (int column = 0; column < image.camera.width; ++column) {
      const Eigen::Vector3d in_sensor =
          image.true_depth[image.index(column, row)] * image.camera.direction(column, row);
      const Eigen::Vector3d in_map = frame.map_from_body * options.body_from_sensor * in_sensor;
      EXPECT_GT(in_map.z(), -1e-12);
    }
  }
}

TEST(Simulator, RefusesOptionsThatMakeNoSense) {
  const auto refused = [](auto change) {
    SimulationOptions options;
    change(options);
    EXPECT_THROW(simulatorOf("room", options), std::invalid_argument);
  };
  refused([](auto& o) { o.frames = -1; });
  refused([](auto& o) { o.passes = 0; });
  refused([](auto& o) { o.rate = -1.0; });
  refused([](auto& o) { o.rate = std::nan(""); });
  refused([](auto& o) { o.drop_rate = 1.0; });
  refused([](auto& o) { o.decimation = 0; });
  refused([](auto& o) { o.kidnap = {{0.6, 0.4}}; });
  refused([](auto& o) { o.kidnap = {{0.5, 1.0}}; });
  EXPECT_THROW(simulatedSensorFromName("camera"), std::invalid_argument);
  SimulationOptions options;
  options.frames = 3;
  EXPECT_THROW(simulatorOf("room", options).frame(3), std::invalid_argument);
  EXPECT_THROW(simulatorOf("room", options).frame(-1), std::invalid_argument);
}

/// Median distance of the points of frame b, moved by the true poses, from the planes that the
/// pixels of frame a hit by them lie on; in multiples of the sensor's standard deviation there.
double medianReprojectionError(const World& world, const SimulatedFrame& a, const SimulatedFrame& b,
                               std::size_t& count) {
  const SensorModel sensor;
  const Eigen::Isometry3d a_from_b = a.map_from_body.inverse() * b.map_from_body;
  const DepthImage &image_a = imageOf(a), &image_b = imageOf(b);
  const PinholeCamera& camera = image_a.camera;
  std::vector<double> errors;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const std::size_t i = image_b.index(column, row);
      if (image_b.counts[i] == 0) continue;
      const double depth_b = image_b.counts[i] * image_b.range_unit;
      const Eigen::Vector3d in_a = a_from_b * (depth_b * camera.direction(column, row));
      if (in_a.x() <= 0.1) continue;
      const auto u = static_cast<int>(std::lround(camera.cx - camera.fx * in_a.y() / in_a.x()));
      const auto v = static_cast<int>(std::lround(camera.cy - camera.fy * in_a.z() / in_a.x()));
      if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) continue;
      const std::size_t j = image_a.index(u, v);
      const double depth_a = image_a.counts[j] * image_a.range_unit;
      // Another surface in front or behind is no error of the pose.
      if (image_a.counts[j] == 0 || std::abs(depth_a - in_a.x()) > 0.05 * depth_a) continue;
      const Eigen::Vector3d point_a = depth_a * camera.direction(u, v);
      const Eigen::Vector3d normal =
          a.map_from_body.linear().transpose() * world.sidePlane(image_a.sides[j]).normal();
      const double sigma = std::hypot(sensor.sigma(depth_a), sensor.sigma(depth_b));
      errors.push_back(std::abs(normal.dot(in_a - point_a)) / sigma);
    }
  }
  count = errors.size();
  if (errors.empty()) return 0.0;
  std::nth_element(errors.begin(), errors.begin() + static_cast<long>(errors.size() / 2),
                   errors.end());
  return errors[errors.size() / 2];
}

TEST(Simulator, TruePosesReprojectFramesWithinTheNoiseInEachScene) {
  for (const auto name : builtInScenes()) {
    SCOPED_TRACE(name);
    SimulationOptions options;
    options.frames = 60;
    options.decimation = 2;
    const Simulator simulator = simulatorOf(std::string(name), options);
    int pairs = 0;
    for (int i = 0; i + 2 < simulator.frames(); i += 6) {
      std::size_t count = 0;
      const double error = medianReprojectionError(simulator.scene().world, simulator.frame(i),
                                                   simulator.frame(i + 2), count);
      if (count < 1000) continue;  // turned away
      ++pairs;
      EXPECT_LT(error, 1.0) << "frames " << i << " and " << i + 2;
    }
    EXPECT_GE(pairs, 5);
  }
}

}  // namespace
}  // namespace opp::mapping
