// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/rawlog_reader.h"

#include "support/random.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <functional>

namespace opp::mapping {
namespace {

using mrpt::obs::CObservation3DRangeScan;

/// A wall 2 m ahead of a 6 × 4 camera; pixel (row 1, col 2) measured nothing.
CObservation3DRangeScan::Ptr wall(double time, const std::string& label = "DEPTH") {
  auto scan = CObservation3DRangeScan::Create();
  scan->timestamp = mrpt::Clock::fromDouble(time);
  scan->sensorLabel = label;
  scan->hasRangeImage = true;
  scan->rangeImage_setSize(4, 6);
  scan->rangeImage.fill(2000);
  scan->rangeImage(1, 2) = 0;
  scan->cameraParams.ncols = 6;
  scan->cameraParams.nrows = 4;
  scan->cameraParams.setIntrinsicParamsFromValues(5.0, 5.0, 2.5, 1.5);
  return scan;
}

using Writer = std::function<void(mrpt::serialization::CArchive&)>;

std::filesystem::path write(const std::filesystem::path& file, const Writer& writer) {
  mrpt::io::CFileGZOutputStream stream;
  stream.open(file.string(), 1);
  auto archive = mrpt::serialization::archiveFrom(stream);
  writer(archive);
  stream.close();
  return file;
}

std::string errorOf(const std::filesystem::path& file, const RawlogOptions& options = {}) {
  try {
    RawlogReader reader(file, options);
    while (reader.next()) {
    }
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(RawlogReader, DepthImageBecomesAnOrganizedCloudInTheBodyFrame) {
  const test::TempFolder folder;
  const auto file = write(folder / "a.rawlog", [](auto& archive) {
    const auto scan = wall(12.5);
    scan->sensorPose =
        mrpt::poses::CPose3D(0.1, 0.2, 1.0, M_PI / 2, 0.0, 0.0);  // looks to the left
    archive << *scan;
  });
  RawlogReader reader(file);
  const std::optional<Scan> scan = reader.nextScan();
  ASSERT_TRUE(scan);
  EXPECT_DOUBLE_EQ(scan->timestamp, 12.5);
  EXPECT_EQ(scan->sensor_label, "DEPTH");
  const PointCloud& cloud = scan->cloud_in_body;
  EXPECT_EQ(cloud.rows, 4);
  EXPECT_EQ(cloud.cols, 6);
  EXPECT_TRUE(cloud.viewpoint.isApprox(Eigen::Vector3f(0.1F, 0.2F, 1.0F)));
  // Upper left pixel: forward 2, left 2·2.5/5 = 1, up 2·1.5/5 = 0.6; forward is the body's y.
  EXPECT_TRUE(cloud.points[0].isApprox(Eigen::Vector3f(0.1F - 1.0F, 0.2F + 2.0F, 1.6F), 1e-5F))
      << cloud.points[0].transpose();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_EQ(cloud.points[i].allFinite(), i != 1 * 6 + 2) << i;
  }
  EXPECT_FALSE(reader.nextScan());
  EXPECT_EQ(reader.damage(), "");
}

TEST(RawlogReader, RangesAlongTheRayAreNotDepths) {
  const test::TempFolder folder;
  const auto file = write(folder / "a.rawlog", [](auto& archive) {
    const auto scan = wall(1.0);
    scan->range_is_depth = false;
    archive << *scan;
  });
  RawlogReader reader(file);
  const std::optional<Scan> scan = reader.nextScan();
  ASSERT_TRUE(scan);
  for (const Eigen::Vector3f& point : scan->cloud_in_body.points) {
    if (!point.allFinite()) continue;
    EXPECT_NEAR(point.norm(), 2.0F, 1e-6F);
  }
}

TEST(RawlogReader, FindsDepthImagesBesideTheRawlog) {
  const test::TempFolder folder;
  std::filesystem::create_directory(folder / "a_Images");
  const auto file = write(folder / "a.rawlog", [&](auto& archive) {
    const auto scan = wall(1.0);
    scan->rangeImage_convertToExternalStorage("depth.bin", (folder / "a_Images").string() + "/");
    archive << *scan;
    scan->rangeImage_forceResetExternalStorage();
    const auto lost = wall(2.0);
    lost->rangeImage_convertToExternalStorage("lost.bin", (folder / "a_Images").string() + "/");
    archive << *lost;
  });
  std::filesystem::remove(folder / "a_Images" / "lost.bin");
  RawlogReader reader(file);
  const std::optional<Scan> scan = reader.nextScan();
  ASSERT_TRUE(scan);
  EXPECT_NEAR(scan->cloud_in_body.points[0].x(), 2.0F, 1e-6F);
  EXPECT_FALSE(reader.nextScan());
  EXPECT_EQ(reader.counts().skipped.size(), 1U) << "the missing image is reported";
}

TEST(RawlogReader, PointCloudsTakeTheSensorsPose) {
  const test::TempFolder folder;
  const auto file = write(folder / "a.rawlog", [](auto& archive) {
    mrpt::obs::CObservationPointCloud observation;
    const auto map = mrpt::maps::CSimplePointsMap::Create();
    map->insertPoint(1.0F, 0.0F, 0.0F);
    map->insertPoint(0.0F, 1.0F, 0.0F);
    observation.pointcloud = map;
    observation.sensorPose = mrpt::poses::CPose3D(0.0, 0.0, 0.5, M_PI, 0.0, 0.0);
    archive << observation;
  });
  RawlogReader reader(file);
  const std::optional<Scan> scan = reader.nextScan();
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->cloud_in_body.size(), 2U);
  EXPECT_FALSE(scan->cloud_in_body.organized());
  EXPECT_LT((scan->cloud_in_body.points[0] - Eigen::Vector3f(-1.0F, 0.0F, 0.5F)).norm(), 1e-6F);
}

TEST(RawlogReader, SelectsByLabelRangeAndStep) {
  const test::TempFolder folder;
  const auto file = write(folder / "a.rawlog", [](auto& archive) {
    for (int k = 0; k < 20; ++k) {
      archive << *wall(k, "LEFT");
      archive << *wall(k + 0.5, "RIGHT");
    }
  });
  RawlogOptions options;
  options.sensor_label = "RI.*";
  options.from_index = 3;
  options.to_index = 12;
  options.every = 4;
  RawlogReader reader(file, options);
  std::vector<double> times;
  while (const auto scan = reader.nextScan()) times.push_back(scan->timestamp);
  EXPECT_EQ(times, (std::vector<double>{3.5, 7.5, 11.5}));
  EXPECT_EQ(reader.counts().scans, 3U);
  EXPECT_EQ(reader.counts().deselected, 37U);
  options.sensor_label = "MIDDLE";
  EXPECT_NE(errorOf(file, options).find("20 x 'LEFT', 20 x 'RIGHT'"), std::string::npos);
}

TEST(RawlogReader, IncrementsOfActionsAddUpToOdometry) {
  const test::TempFolder folder;
  const auto file = write(folder / "a.rawlog", [](auto& archive) {
    for (int k = 0; k < 3; ++k) {
      mrpt::obs::CActionCollection actions;
      if (k % 2 == 0) {
        mrpt::obs::CActionRobotMovement3D move;
        move.poseChange.mean = mrpt::poses::CPose3D(1.0, 0.0, 0.0, M_PI / 2, 0.0, 0.0);
        actions.insert(move);
      } else {
        mrpt::obs::CActionRobotMovement2D move;
        move.computeFromOdometry(mrpt::poses::CPose2D(1.0, 0.0, M_PI / 2), {});
        actions.insert(move);
      }
      mrpt::obs::CSensoryFrame frame;
      frame.insert(wall(10.0 + k));
      archive << actions << frame;
    }
  });
  RawlogReader reader(file);
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> times;
  std::size_t scans = 0;
  while (const auto entry = reader.next()) {
    if (const auto* odometry = std::get_if<OdometryReading>(&*entry)) {
      EXPECT_EQ(scans, positions.size()) << "the reading precedes the scan it leads to";
      positions.push_back(odometry->odom_from_body.translation());
      times.push_back(odometry->timestamp);
    } else {
      ++scans;
    }
  }
  EXPECT_EQ(scans, 3U);
  EXPECT_EQ(times, (std::vector<double>{10.0, 11.0, 12.0}));
  ASSERT_EQ(positions.size(), 3U);
  EXPECT_LT((positions[0] - Eigen::Vector3d(1.0, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((positions[1] - Eigen::Vector3d(1.0, 1.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((positions[2] - Eigen::Vector3d(0.0, 1.0, 0.0)).norm(), 1e-12);
}

TEST(RawlogReader, AbsoluteOdometryIsPassedOn) {
  const test::TempFolder folder;
  const auto file = write(folder / "a.rawlog", [](auto& archive) {
    mrpt::obs::CObservationComment comment;
    mrpt::obs::CObservationOdometry odometry;
    odometry.timestamp = mrpt::Clock::fromDouble(4.0);
    odometry.odometry = mrpt::poses::CPose2D(1.0, 2.0, 0.5);
    archive << comment << odometry << *wall(4.0) << mrpt::obs::CObservation2DRangeScan();
  });
  RawlogReader reader(file);
  const auto entry = reader.next();
  ASSERT_TRUE(entry && std::holds_alternative<OdometryReading>(*entry));
  const auto& reading = std::get<OdometryReading>(*entry);
  EXPECT_DOUBLE_EQ(reading.timestamp, 4.0);
  EXPECT_EQ(reading.odom_from_body.translation(), Eigen::Vector3d(1.0, 2.0, 0.0));
  EXPECT_TRUE(reader.nextScan());
  EXPECT_FALSE(reader.nextScan());
  EXPECT_EQ(reader.counts().skipped.at("mrpt::obs::CObservation2DRangeScan"), 1U);
}

TEST(RawlogReader, ReadsARawlogObjectAndALoneFrame) {
  const test::TempFolder folder;
  const auto file = write(folder / "a.rawlog", [](auto& archive) {
    mrpt::obs::CRawlog rawlog;
    for (int k = 0; k < 5; ++k)
      rawlog.insert(std::static_pointer_cast<mrpt::obs::CObservation>(wall(k)));
    mrpt::obs::CSensoryFrame frame;
    frame.insert(wall(5.0));
    archive << rawlog << frame;
  });
  RawlogReader reader(file);
  int frames = 0;
  while (reader.nextScan()) ++frames;
  EXPECT_EQ(frames, 6);
}

TEST(RawlogReader, NamesWhatIsWrongWithTheInput) {
  const test::TempFolder folder;
  EXPECT_NE(errorOf(folder / "none.rawlog").find("none.rawlog does not exist"), std::string::npos);
  EXPECT_NE(errorOf(folder.path()).find("is not a file"), std::string::npos);
  test::writeFile(folder / "empty.rawlog", "");
  EXPECT_NE(errorOf(folder / "empty.rawlog").find("empty.rawlog is empty"), std::string::npos);
  const auto flat = write(folder / "flat.rawlog", [](auto& archive) {
    archive << mrpt::obs::CObservation2DRangeScan() << mrpt::obs::CObservation2DRangeScan();
  });
  EXPECT_NE(errorOf(flat).find("2 x 'mrpt::obs::CObservation2DRangeScan'"), std::string::npos)
      << errorOf(flat);
  EXPECT_THROW(RawlogReader(flat, RawlogOptions{"[", 0, 1, 1, {}}), std::invalid_argument);
  EXPECT_THROW(RawlogReader(flat, RawlogOptions{"", 1, 1, 1, {}}), std::invalid_argument);
  EXPECT_THROW(RawlogReader(flat, RawlogOptions{"", 0, 1, 0, {}}), std::invalid_argument);
}

TEST(RawlogReader, RandomBytesAreAnError) {
  const test::TempFolder folder;
  test::Random random(5);
  for (int k = 0; k < 50; ++k) {
    std::string bytes(static_cast<std::size_t>(random.integer(1, 3000)), '\0');
    for (char& byte : bytes) byte = static_cast<char>(random.integer(0, 255));
    test::writeFile(folder / "noise.rawlog", bytes);
    EXPECT_NE(errorOf(folder / "noise.rawlog").find("noise.rawlog"), std::string::npos) << k;
  }
}

TEST(RawlogReader, EveryTruncationKeepsTheScansBeforeIt) {
  const test::TempFolder folder;
  for (const bool compressed : {true, false}) {
    const auto whole = folder / "whole.rawlog";
    mrpt::io::CFileGZOutputStream stream;
    stream.open(whole.string(), compressed ? 1 : 0);
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (int k = 0; k < 8; ++k) archive << *wall(k);
    stream.close();
    const std::string bytes = test::readFile(whole);
    test::Random random(7);
    for (int k = 0; k < 50; ++k) {
      const auto length = static_cast<std::size_t>(
          random.integer(static_cast<int>(bytes.size() / 2), static_cast<int>(bytes.size()) - 1));
      test::writeFile(folder / "cut.rawlog", bytes.substr(0, length));
      RawlogReader reader(folder / "cut.rawlog");
      std::size_t frames = 0;
      try {
        while (reader.nextScan()) ++frames;
      } catch (const std::runtime_error&) {
        EXPECT_EQ(frames, 0U);
      }
      EXPECT_EQ(reader.counts().objects, frames);
      EXPECT_TRUE(frames == 8 || !reader.damage().empty()) << length << " of " << bytes.size();
    }
  }
}

}  // namespace
}  // namespace opp::mapping
