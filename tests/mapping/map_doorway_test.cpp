// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/core/se3.h"
#include "opp/mapping/pipeline/mapper.h"
#include "opp/mapping/simulation/scene.h"
#include "opp/mapping/simulation/simulator.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

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

/// The map of some frames of a simulated walk, in the frame of the truth. \param lost how many of
/// them were not localized
Mapper mapOf(const Simulator& simulator, int first, int last, int& lost) {
  Mapper mapper{MapperParams()};
  mapper.setInitialPose(simulator.mapFromBody(first));
  lost = 0;
  for (int index = first; index <= last; ++index)
    lost += mapper.add(featuresOf(simulator, index), std::nullopt).localized ? 0 : 1;
  return mapper;
}

class DoorFrom : public testing::TestWithParam<int> {};

TEST_P(DoorFrom, StaysLocalized) {
  // Frames in which a hand-held camera passes a door frame. What constant velocity knows 0.2 s
  // after the last scan starts the match on a coarse level, whose surfels average the near door
  // frame with the walls of the next room and would turn the pose by 20 degrees.
  const Simulator simulator(loadScene("apartment"), SimulationOptions());
  int lost = 0;
  const Mapper mapper = mapOf(simulator, GetParam(), 62, lost);
  EXPECT_EQ(lost, 0);
  ASSERT_EQ(mapper.parts().size(), 1U);
  for (const auto& [index, pose] : posesOf(mapper.map(), 0)) {
    const Vector6d error = difference(simulator.mapFromBody(static_cast<int>(index)), pose);
    EXPECT_LT(error.head<3>().norm(), 0.01) << "frame " << index;
    EXPECT_LT(error.tail<3>().norm(), 0.03) << "frame " << index;
  }
}

// Each knows another part of the room before the door.
INSTANTIATE_TEST_SUITE_P(Mapper, DoorFrom, testing::Values(33, 45, 50));

TEST(Mapper, DoesNotSlideAlongAWallWhereLittleStructureLeads) {
  // Frames in which a camera turns past the end of a wardrobe to a bare wall. From frame 113 on,
  // registration moved the last of the structure, and so the body, by 0.17 m a frame.
  SimulationOptions options;
  options.seed = 35;
  options.kidnap = {0.6, 0.8};
  const Simulator simulator(loadScene("apartment"), options);
  int lost = 0;
  const Mapper mapper = mapOf(simulator, 79, 116, lost);
  EXPECT_LE(lost, 2);
  ASSERT_EQ(mapper.parts().size(), 1U);
  for (const auto& [index, pose] : posesOf(mapper.map(), 0)) {
    const Vector6d error = difference(simulator.mapFromBody(static_cast<int>(index)), pose);
    EXPECT_LT(error.tail<3>().norm(), 0.05) << "frame " << index;
  }
}

TEST(Mapper, CornerThatResemblesTheLastOneIsANewOne) {
  // A camera turns on the spot in a bare square room: from one corner past a wall to the next,
  // which looks the same. Motion knows the turn past the wall to no better than 50 degrees.
  std::istringstream room(
      "[room]\ncorner = 0 0\ncorner = 4 0\ncorner = 4 4\ncorner = 0 4\nheight = 2.5\n"
      "[path]\nwaypoint = 2 2 1.3 45 deg 10 deg\nwaypoint = 2 2 1.3 225 deg 10 deg\n");
  SimulationOptions options;
  options.frames = 21;
  for (options.seed = 1; options.seed <= 3; ++options.seed) {
    room.clear();
    room.seekg(0);
    const Simulator simulator(parseScene(room, "room"), options);
    int lost = 0;
    Mapper mapper = mapOf(simulator, 0, options.frames - 1, lost);
    EXPECT_LT(lost, 10);
    mapper.finish();
    for (const MapPart& part : mapper.parts()) {
      const auto poses = posesOf(part.map, 0);
      const auto& [first, map_from_first] = *poses.begin();
      const Eigen::Isometry3d true_first = simulator.mapFromBody(static_cast<int>(first));
      for (const auto& [index, pose] : poses) {
        const Eigen::Isometry3d truth = simulator.mapFromBody(static_cast<int>(index));
        const Vector6d error =
            difference(true_first.inverse() * truth, map_from_first.inverse() * pose);
        EXPECT_LT(error.head<3>().norm(), 0.02) << options.seed << ": frame " << index;
        EXPECT_LT(error.tail<3>().norm(), 0.05) << options.seed << ": frame " << index;
      }
    }
  }
}

}  // namespace
}  // namespace opp::mapping
