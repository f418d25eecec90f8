// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/simplemap.h"

#include "opp/mapping/io/mrpt_convert.h"

#include "support/random.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

namespace opp::mapping {
namespace {

/// A wall 2 m ahead of the sensor, which sits 1 m above the body.
mrpt::obs::CObservation3DRangeScan::Ptr wall(double time) {
  auto scan = mrpt::obs::CObservation3DRangeScan::Create();
  scan->timestamp = mrpt::Clock::fromDouble(time);
  scan->sensorLabel = "DEPTH";
  scan->sensorPose = mrpt::poses::CPose3D(0.0, 0.0, 1.0, 0.0, 0.0, 0.0);
  scan->hasRangeImage = true;
  scan->rangeImage_setSize(4, 6);
  scan->rangeImage.fill(2000);
  scan->cameraParams.ncols = 6;
  scan->cameraParams.nrows = 4;
  scan->cameraParams.setIntrinsicParamsFromValues(5.0, 5.0, 2.5, 1.5);
  return scan;
}

std::filesystem::path rawlogOf(int scans, const test::TempFolder& folder, bool external) {
  const auto file = folder / "a.rawlog";
  const std::string images = (folder / "a_Images").string();
  std::filesystem::create_directory(images);
  mrpt::io::CFileGZOutputStream stream(file.string());
  auto archive = mrpt::serialization::archiveFrom(stream);
  for (int k = 0; k < scans; ++k) {
    const auto scan = wall(k);
    if (external) {
      scan->rangeImage_convertToExternalStorage("depth" + std::to_string(k) + ".bin", images + "/");
    }
    archive << *scan;
  }
  return file;
}

TEST(WriteSimplemap, MrptBuildsTheMapFromIt) {
  test::Random random(1);
  for (const bool external : {false, true}) {
    const test::TempFolder folder;
    const auto rawlog = rawlogOf(10, folder, external);
    std::map<std::size_t, Eigen::Isometry3d> keyframes;
    for (const std::size_t index : {0U, 3U, 7U}) keyframes[index] = random.pose(3.0);
    writeSimplemap(folder / "map.simplemap", {{rawlog, keyframes}}, {});
    std::filesystem::remove_all(folder / "a_Images");  // nothing outside is needed

    mrpt::maps::CSimpleMap map;
    ASSERT_TRUE(map.loadFromFile((folder / "map.simplemap").string()));
    ASSERT_EQ(map.size(), 3U);
    auto expected = keyframes.begin();
    for (std::size_t k = 0; k < 3; ++k, ++expected) {
      mrpt::poses::CPose3DPDF::Ptr pose;
      mrpt::obs::CSensoryFrame::Ptr frame;
      map.get(k, pose, frame);
      EXPECT_TRUE(toIsometry(pose->getMeanVal()).isApprox(expected->second, 1e-9));
      const auto observation = frame->getObservationByIndex(0);
      EXPECT_DOUBLE_EQ(mrpt::Clock::toDouble(observation->timestamp), double(expected->first));
      mrpt::maps::CSimplePointsMap points;
      points.insertionOptions.minDistBetweenLaserPoints = 0.0F;
      const mrpt::poses::CPose3D robot = pose->getMeanVal();
      ASSERT_TRUE(observation->insertObservationInto(points, robot));
      ASSERT_EQ(points.size(), 24U);
      // Upper left pixel: 2 m forward, 1 m left, 0.6 m above the sensor.
      Eigen::Vector3f first;
      points.getPoint(0, first.x(), first.y(), first.z());
      const Eigen::Vector3d in_body = expected->second.inverse() * first.cast<double>();
      EXPECT_LT((in_body - Eigen::Vector3d(2.0, 1.0, 1.6)).norm(), 1e-5);
    }
  }
}

TEST(WriteSimplemap, MissingKeyframesLeaveNoFile) {
  const test::TempFolder folder;
  const auto rawlog = rawlogOf(3, folder, false);
  EXPECT_THROW(writeSimplemap(folder / "map.simplemap",
                              {{rawlog, {{5, Eigen::Isometry3d::Identity()}}}}, {}),
               std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(folder / "map.simplemap"));
  EXPECT_THROW(writeSimplemap(folder / "map.simplemap",
                              {{folder / "none.rawlog", {{0, Eigen::Isometry3d::Identity()}}}}, {}),
               std::runtime_error);
  EXPECT_THROW(writeSimplemap("/nowhere/map.simplemap", {{rawlog, {}}}, {}), std::exception);
}

TEST(WriteSimplemap, HoldsTheKeyframesOfAllSessions) {
  const test::TempFolder folder;
  const auto rawlog = rawlogOf(3, folder, false);
  const std::map<std::size_t, Eigen::Isometry3d> one{{1, Eigen::Isometry3d::Identity()}};
  const std::map<std::size_t, Eigen::Isometry3d> two{{0, Eigen::Isometry3d::Identity()},
                                                     {2, Eigen::Isometry3d::Identity()}};
  writeSimplemap(folder / "map.simplemap", {{rawlog, one}, {rawlog, two}}, {});
  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile((folder / "map.simplemap").string()));
  EXPECT_EQ(map.size(), 3U);
}

TEST(WriteSimplemap, NoKeyframesIsAnEmptyMap) {
  const test::TempFolder folder;
  writeSimplemap(folder / "map.simplemap", {{rawlogOf(1, folder, false), {}}}, {});
  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile((folder / "map.simplemap").string()));
  EXPECT_EQ(map.size(), 0U);
}

}  // namespace
}  // namespace opp::mapping
