// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/rawlog_reader.h"

#include "support/random.h"
#include "support/shared_data.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/maps/registerAllClasses.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

std::size_t validPoints(const PointCloud& cloud) {
  return static_cast<std::size_t>(
      std::count_if(cloud.points.begin(), cloud.points.end(),
                    [](const Eigen::Vector3f& point) { return point.allFinite(); }));
}

struct Sequence {
  const char* file;
  std::size_t frames;
  int rows, cols;
};

class RecordedSequence : public testing::TestWithParam<Sequence> {};

TEST_P(RecordedSequence, IsReadWhole) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  RawlogReader reader(test::sharedData(GetParam().file));
  double last_time = 0.0;
  std::size_t frames = 0;
  while (const std::optional<Scan> scan = reader.nextScan()) {
    EXPECT_EQ(scan->index, frames++);
    EXPECT_GT(scan->timestamp, last_time);
    last_time = scan->timestamp;
    EXPECT_EQ(scan->cloud_in_body.rows, GetParam().rows);
    EXPECT_EQ(scan->cloud_in_body.cols, GetParam().cols);
    EXPECT_GT(validPoints(scan->cloud_in_body), 1000U);
  }
  EXPECT_EQ(frames, GetParam().frames);
  EXPECT_EQ(reader.damage(), "");
  EXPECT_TRUE(reader.counts().skipped.empty());
  EXPECT_DOUBLE_EQ(reader.progress(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(All, RecordedSequence,
                         testing::Values(Sequence{"tum_fr3_structure_notexture_far.rawlog", 252,
                                                  480, 640},
                                         Sequence{"icl_of_kt3.rawlog", 101, 480, 640},
                                         Sequence{"redwood_livingroom1.rawlog", 211, 480, 640},
                                         Sequence{"simulated_lidar_hall.rawlog", 51, 0, 0}),
                         [](const testing::TestParamInfo<Sequence>& sequence) {
                           const std::string name = sequence.param.file;
                           return name.substr(0, name.find('.'));
                         });

Scan onlyScanOf(const char* fixture) {
  RawlogReader reader(test::sharedData(fixture));
  std::optional<Scan> scan = reader.nextScan();
  EXPECT_TRUE(scan.has_value());
  EXPECT_FALSE(reader.nextScan().has_value());
  return scan.value_or(Scan());
}

TEST(RawlogFixture, VelodyneSweepHasAllOfItsReturns) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const Scan scan = onlyScanOf("fixtures/test_velodyne_VLP16.rawlog");
  EXPECT_EQ(validPoints(scan.cloud_in_body), 11305U);
  EXPECT_NEAR(scan.cloud_in_body.viewpoint.z(), 0.09F, 1e-6F);
}

TEST(RawlogFixture, RotatingScanIsTheVelodyneSweep) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const PointCloud rotating = onlyScanOf("fixtures/rot_scan_velodyne.rawlog").cloud_in_body;
  const PointCloud velodyne = onlyScanOf("fixtures/test_velodyne_VLP16.rawlog").cloud_in_body;
  EXPECT_EQ(rotating.rows, 16);
  EXPECT_TRUE(rotating.columns_wrap);
  EXPECT_EQ(validPoints(rotating), 11305U);
  std::vector<float> distances;
  for (const Eigen::Vector3f& point : rotating.points) {
    if (!point.allFinite()) continue;
    float nearest = std::numeric_limits<float>::max();
    for (const Eigen::Vector3f& other : velodyne.points) {
      nearest = std::min(nearest, (point - other).squaredNorm());
    }
    distances.push_back(std::sqrt(nearest));
  }
  std::sort(distances.begin(), distances.end());
  // The class stores the first and last azimuth only; interpolation costs 0.022 m (median).
  EXPECT_LT(distances[distances.size() / 2], 0.03F);
  EXPECT_LT(distances[distances.size() * 9 / 10], 0.08F);
}

TEST(RawlogFixture, LoneFrameWithTiltedSensorLandsInTheBodyFrame) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const Scan scan = onlyScanOf("fixtures/test-3d-obs-ground.rawlog");
  EXPECT_EQ(scan.sensor_label, "OBS");
  EXPECT_EQ(scan.cloud_in_body.rows, 240);
  EXPECT_NEAR(scan.cloud_in_body.viewpoint.z(), 1.273F, 1e-3F);
  // It looks down at the ground from 1.27 m: the median height is the ground's, 0 ± a few cm.
  std::vector<float> heights;
  for (const auto& point : scan.cloud_in_body.points) {
    if (point.allFinite()) heights.push_back(point.z());
  }
  std::nth_element(heights.begin(), heights.begin() + static_cast<long>(heights.size() / 2),
                   heights.end());
  EXPECT_NEAR(heights[heights.size() / 2], 0.0F, 0.1F);
}

TEST(RawlogFixture, LensDistortionIsUndoneAsMrptDoes) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const Scan scan = onlyScanOf("fixtures/tests_rgbd.rawlog");
  mrpt::maps::registerAllClasses_mrpt_maps();
  mrpt::io::CFileGZInputStream file(test::sharedData("fixtures/tests_rgbd.rawlog").string());
  mrpt::obs::CObservation3DRangeScan::Ptr observation;
  auto archive = mrpt::serialization::archiveFrom(file);
  archive >> observation;
  mrpt::maps::CSimplePointsMap map;
  observation->unprojectInto(map);
  ASSERT_EQ(map.size(), 273225U);
  std::size_t i = 0;
  float worst = 0.0F;
  for (const auto& point : scan.cloud_in_body.points) {
    if (!point.allFinite()) continue;
    ASSERT_LT(i, map.size());
    Eigen::Vector3f expected;
    map.getPoint(i++, expected.x(), expected.y(), expected.z());
    worst = std::max(worst, (point - expected).norm());
  }
  EXPECT_EQ(i, map.size());
  // MRPT inverts the lens model with OpenCV's few fixed-point steps; at 2.6 m 1 mm is 0.2 pixels.
  EXPECT_LT(worst, 1e-3F);
}

TEST(RawlogReader, DeliversWhatCameBeforeATruncation) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const test::TempFolder folder;
  const std::string bytes = test::readFile(test::sharedData("icl_of_kt3.rawlog"));
  test::writeFile(folder / "cut.rawlog", bytes.substr(0, bytes.size() / 2));
  RawlogReader reader(folder / "cut.rawlog");
  std::size_t frames = 0;
  while (reader.nextScan()) ++frames;
  EXPECT_GT(frames, 40U);
  EXPECT_LT(frames, 61U);
  EXPECT_NE(reader.damage().find("cut.rawlog is damaged after"), std::string::npos)
      << reader.damage();
}

/// Reads a file to its end, whatever it is like; the number of scans, or −1 for an error.
int scansOf(const std::filesystem::path& file) {
  try {
    RawlogReader reader(file);
    int scans = 0;
    while (const std::optional<Scan> scan = reader.nextScan()) {
      EXPECT_GT(scan->cloud_in_body.size(), 0U);
      ++scans;
    }
    return scans;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(file.filename().string()), std::string::npos)
        << error.what();
    return -1;
  }
}

class DamagedRawlog : public testing::TestWithParam<const char*> {};

/// Fixed seeds: MRPT 2.5 itself can crash on damaged action/frame rawlogs, never on these.
TEST_P(DamagedRawlog, IsAnErrorOrReadButNoCrash) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const std::string bytes = test::readFile(test::sharedData(GetParam()));
  const test::TempFolder folder;
  test::Random random(11);
  const auto position = [&] {
    return static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
  };
  int errors = 0;
  for (int k = 0; k < 60; ++k) {
    std::string damaged = bytes;
    if (k % 3 == 0) {
      damaged.resize(position());
    } else if (k % 3 == 1) {
      for (int flip = 0; flip < 3; ++flip) {
        damaged[position()] ^= static_cast<char>(1 << random.integer(0, 7));
      }
    } else {
      const std::size_t begin = position();
      for (std::size_t i = begin; i < std::min(bytes.size(), begin + 64); ++i) {
        damaged[i] = static_cast<char>(random.integer(0, 255));
      }
    }
    test::writeFile(folder / "damaged.rawlog", damaged);
    if (scansOf(folder / "damaged.rawlog") < 0) ++errors;
  }
  EXPECT_GT(errors, 20);  // at least the truncated third, less a few cut at the very end
}

INSTANTIATE_TEST_SUITE_P(All, DamagedRawlog,
                         testing::Values("fixtures/test-3d-obs-ground.rawlog",
                                         "fixtures/test_velodyne_VLP16.rawlog",
                                         "fixtures/rot_scan_velodyne.rawlog"),
                         [](const testing::TestParamInfo<const char*>& file) {
                           std::string name = std::filesystem::path(file.param).stem();
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace opp::mapping
