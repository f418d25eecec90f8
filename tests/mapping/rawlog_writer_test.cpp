// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/rawlog_writer.h"

#include "opp/mapping/io/rawlog_reader.h"

#include "support/random.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace opp::mapping {
namespace {

RawlogDepthImage smallImage() {
  RawlogDepthImage image;
  image.width = 3;
  image.height = 2;
  image.fx = image.fy = 2.0;
  image.cx = 1.0;
  image.cy = 0.5;
  image.max_range = 5.0;
  image.counts = {1000, 2000, 0, 65535, 1, 3000};
  return image;
}

std::vector<Scan> scansOf(const std::filesystem::path& file) {
  RawlogReader reader(file);
  std::vector<Scan> scans;
  while (auto scan = reader.nextScan()) scans.push_back(*scan);
  EXPECT_EQ(reader.damage(), "");
  return scans;
}

TEST(RawlogWriter, DepthReadsBackAsPointsOfTheBody) {
  const test::TempFolder folder;
  RawlogStamp stamp{1234567.5, "DEPTH", Eigen::Isometry3d::Identity()};
  stamp.body_from_sensor.translation() << 0.1, 0.2, 1.0;
  RawlogWriter writer(folder / "a.rawlog");
  writer.write(stamp, smallImage());
  writer.close();
  const auto scans = scansOf(folder / "a.rawlog");
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_DOUBLE_EQ(scans[0].timestamp, 1234567.5);
  EXPECT_EQ(scans[0].sensor_label, "DEPTH");
  const PointCloud& cloud = scans[0].cloud_in_body;
  ASSERT_EQ(cloud.rows, 2);
  ASSERT_EQ(cloud.cols, 3);
  // Pixel (1, 0): 2 m ahead, (cy − 0)/fy · 2 m above; float32.
  EXPECT_TRUE(cloud.points[1].isApprox(Eigen::Vector3f(2.1F, 0.2F, 1.5F), 1e-6F));
  EXPECT_FALSE(cloud.points[2].allFinite());
}

TEST(RawlogWriter, PointsReadBackBitForBit) {
  const test::TempFolder folder;
  test::Random random(4);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 500; ++i) points.push_back(random.vector(50.0).cast<float>());
  RawlogWriter writer(folder / "a.rawlog");
  writer.write({10.0, "LIDAR", Eigen::Isometry3d::Identity()}, points);
  writer.close();
  const auto scans = scansOf(folder / "a.rawlog");
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].cloud_in_body.points, points);
}

TEST(RawlogWriter, OdometryReadsBackInBothFormats) {
  for (const bool actions : {false, true}) {
    const test::TempFolder folder;
    RawlogWriter writer(folder / "a.rawlog", {actions, 1});
    std::vector<Eigen::Isometry3d> poses(3, Eigen::Isometry3d::Identity());
    poses[1].translation() << 1.0, 0.5, 0.0;
    poses[2] = poses[1] * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ());
    poses[2].translation().x() = 2.0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double time = 100.0 + static_cast<double>(i);
      writer.writeOdometry(time, poses[i]);
      writer.write({time, "DEPTH", Eigen::Isometry3d::Identity()}, smallImage());
    }
    writer.close();
    RawlogReader reader(folder / "a.rawlog");
    std::vector<Eigen::Isometry3d> read;
    while (auto entry = reader.next()) {
      if (const auto* odometry = std::get_if<OdometryReading>(&*entry)) {
        read.push_back(odometry->odom_from_body);
      }
    }
    ASSERT_EQ(read.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE((read[0].inverse() * read[i]).isApprox(poses[i], 1e-9)) << actions << " " << i;
    }
  }
}

TEST(RawlogWriter, EqualCallsGiveEqualBytes) {
  const test::TempFolder folder;
  for (const auto* name : {"a.rawlog", "b.rawlog"}) {
    RawlogWriter writer(folder / name, {true, 6});
    writer.writeOdometry(7.0, Eigen::Isometry3d::Identity());
    writer.write({7.0, "DEPTH", Eigen::Isometry3d::Identity()}, smallImage());
    writer.close();
  }
  EXPECT_EQ(test::readFile(folder / "a.rawlog"), test::readFile(folder / "b.rawlog"));
}

TEST(RawlogWriter, LeavesNothingBehindUnlessClosed) {
  const test::TempFolder folder;
  {
    RawlogWriter writer(folder / "a.rawlog");
    writer.write({7.0, "DEPTH", Eigen::Isometry3d::Identity()}, smallImage());
  }
  EXPECT_TRUE(folder.contents().empty());
}

TEST(RawlogWriter, RefusesWhatNoReaderCouldUse) {
  const test::TempFolder folder;
  EXPECT_THROW(RawlogWriter(folder / "none" / "a.rawlog"), std::runtime_error);
  EXPECT_THROW(RawlogWriter(folder / "a.rawlog", {false, 10}), std::invalid_argument);
  RawlogWriter writer(folder / "a.rawlog");
  RawlogDepthImage image = smallImage();
  image.counts.pop_back();
  EXPECT_THROW(writer.write({1.0, "D", Eigen::Isometry3d::Identity()}, image),
               std::invalid_argument);
  image = smallImage();
  image.fx = 0.0;
  EXPECT_THROW(writer.write({1.0, "D", Eigen::Isometry3d::Identity()}, image),
               std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
