// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/core/se3.h"
#include "opp/mapping/pipeline/mapper.h"
#include "opp/mapping/simulation/scene.h"
#include "opp/mapping/simulation/simulator.h"

#include <gtest/gtest.h>

#include <limits>

namespace opp::mapping {
namespace {

/// In the sensor's frame.
PointCloud pointsOf(const DepthImage& image) {
  const PinholeCamera& camera = image.camera;
  PointCloud cloud;
  cloud.rows = camera.height;
  cloud.cols = camera.width;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const std::uint16_t count = image.counts[image.index(column, row)];
      const double depth =
          count == 0 ? std::numeric_limits<double>::quiet_NaN() : count * image.range_unit;
      cloud.points.emplace_back((depth * camera.direction(column, row)).cast<float>());
    }
  }
  return cloud;
}

/// What a scan of a known pose shows.
ScanFeatures featuresOf(const Simulator& simulator, int index) {
  const SimulatedFrame frame = simulator.frame(index);
  ScanFeatures scan = detectFeatures(pointsOf(std::get<DepthImage>(frame.data)), PrimitiveParams());
  scan.timestamp = frame.timestamp;
  scan.scan_index = static_cast<std::size_t>(index);
  return scan;
}

class DoorFrom : public testing::TestWithParam<int> {};

TEST_P(DoorFrom, StaysLocalized) {
  // Frames in which a hand-held camera passes a door frame. What constant velocity knows 0.2 s
  // after the last scan starts the match on a coarse level, whose surfels average the near door
  // frame with the walls of the next room and would turn the pose by 20 degrees.
  const int first = GetParam();
  constexpr int kLast = 62;
  const Simulator simulator(loadScene("apartment"), SimulationOptions());
  Mapper mapper{MapperParams()};
  mapper.setInitialPose(simulator.mapFromBody(first));
  for (int index = first; index <= kLast; ++index) {
    EXPECT_TRUE(mapper.add(featuresOf(simulator, index), std::nullopt).localized)
        << "frame " << index;
  }
  ASSERT_EQ(mapper.parts().size(), 1U);
  const auto poses = posesOf(mapper.map(), 0);
  for (const auto& [index, pose] : poses) {
    const Vector6d error = difference(simulator.mapFromBody(static_cast<int>(index)), pose);
    EXPECT_LT(error.head<3>().norm(), 0.01) << "frame " << index;
    EXPECT_LT(error.tail<3>().norm(), 0.03) << "frame " << index;
  }
}

// Each knows another part of the room before the door.
INSTANTIATE_TEST_SUITE_P(Mapper, DoorFrom, testing::Values(33, 45, 50));

}  // namespace
}  // namespace opp::mapping
