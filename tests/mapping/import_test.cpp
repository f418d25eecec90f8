// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/importing/import_plan.h"
#include "opp/mapping/importing/run_import.h"
#include "opp/mapping/io/cloud_file.h"
#include "opp/mapping/io/gray16_png.h"

#include "support/gray_png.h"
#include "support/random.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/maps/registerAllClasses.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp::mapping {
namespace {

namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationPointCloud;

constexpr int kWidth = 8;
constexpr int kHeight = 6;

/// Pixels of all kinds: 0, 65535, 1, and random ones.
std::vector<std::uint16_t> randomPixels(test::Random& random) {
  std::vector<std::uint16_t> pixels{0, 65535, 1, 65534};
  while (pixels.size() < kWidth * kHeight) {
    pixels.push_back(static_cast<std::uint16_t>(random.integer(0, 65535)));
  }
  return pixels;
}

template <typename Observation>
std::vector<std::shared_ptr<Observation>> readAll(const fs::path& rawlog) {
  mrpt::maps::registerAllClasses_mrpt_maps();
  mrpt::io::CFileGZInputStream stream(rawlog.string());
  auto archive = mrpt::serialization::archiveFrom(stream);
  std::vector<std::shared_ptr<Observation>> observations;
  try {
    while (true) {
      mrpt::serialization::CSerializable::Ptr object;
      archive >> object;
      observations.push_back(std::dynamic_pointer_cast<Observation>(object));
    }
  } catch (const mrpt::serialization::CExceptionEOF&) {
  }
  return observations;
}

/// The depth that a rawlog should hold: the file's, with the code for "none" turned into 0.
std::vector<std::uint16_t> expectedCounts(std::vector<std::uint16_t> pixels, bool flipped) {
  std::replace(pixels.begin(), pixels.end(), std::uint16_t{65535}, std::uint16_t{0});
  if (!flipped) return pixels;
  std::vector<std::uint16_t> result;
  for (std::size_t row = kHeight; row-- > 0;) {
    result.insert(result.end(), pixels.begin() + static_cast<std::ptrdiff_t>(row * kWidth),
                  pixels.begin() + static_cast<std::ptrdiff_t>((row + 1) * kWidth));
  }
  return result;
}

std::vector<std::uint16_t> countsOf(const CObservation3DRangeScan& observation) {
  const auto& image = observation.rangeImage;
  return {image.data(), image.data() + image.size()};
}

class Import : public testing::Test {
 protected:
  /// Writes an image and remembers its pixels.
  void addImage(const std::string& name) {
    pixels_.push_back(randomPixels(random_));
    fs::create_directories((folder_ / name).parent_path());
    test::writeGrayPng(folder_ / name, kWidth, kHeight, pixels_.back());
  }
  void addText(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    test::writeFile(folder_ / name, text);
  }
  fs::path rawlog() const { return output_ / "x.rawlog"; }
  ImportPlan plan(DatasetFormat format, ImportOptions options = {}) const {
    if (!options.intrinsics && format != DatasetFormat::kKitti) {
      options.intrinsics = CameraIntrinsics{10.0, 11.0, 3.5, 2.25};  // small images
    }
    return planImport(format, folder_.path(), options);
  }
  std::string planError(DatasetFormat format, const ImportOptions& options = {}) const {
    try {
      plan(format, options);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  }
  /// Imports and compares each pixel with the source.
  std::vector<CObservation3DRangeScan::Ptr> importDepth(const ImportPlan& import, bool flipped) {
    runImport(import, rawlog(), {});
    const auto observations = readAll<CObservation3DRangeScan>(rawlog());
    EXPECT_EQ(observations.size(), pixels_.size());
    for (std::size_t k = 0; k < observations.size(); ++k) {
      EXPECT_EQ(countsOf(*observations[k]), expectedCounts(pixels_[k], flipped)) << k;
      EXPECT_EQ(observations[k]->rangeUnits, static_cast<float>(import.range_unit));
      EXPECT_TRUE(observations[k]->range_is_depth);
      EXPECT_EQ(observations[k]->sensorLabel, "DEPTH");
      EXPECT_NEAR(mrpt::Clock::toDouble(observations[k]->timestamp), import.frames[k].timestamp,
                  1e-6);  // rawlogs store 100 ns, the double resolves 2.4e-7 s
    }
    return observations;
  }

  test::TempFolder folder_;
  test::TempFolder output_;
  test::Random random_{121};
  std::vector<std::vector<std::uint16_t>> pixels_;
};

TEST_F(Import, TumKeepsDepthBitForBitAndTurnsPosesIntoThoseOfTheBody) {
  addImage("depth/a.png");
  addImage("depth/b.png");
  addText("depth.txt", "# depth maps\n100.25 depth/a.png\n100.5 depth/b.png\n");
  // The camera looks along the map's x: optical z = x, optical x = −y, optical y = −z.
  addText("groundtruth.txt", "# t\n100.3 1 2 3 -0.5 0.5 -0.5 0.5\n");
  const ImportPlan import = plan(DatasetFormat::kTum);
  EXPECT_EQ(import.range_unit, 1.0 / 5000.0);
  EXPECT_EQ(import.frames.at(1).timestamp, 100.5);
  ASSERT_EQ(import.ground_truth.size(), 1u);
  EXPECT_TRUE(import.ground_truth[0].map_from_body.linear().isIdentity(1e-12));
  EXPECT_EQ(import.ground_truth[0].map_from_body.translation(), Eigen::Vector3d(1, 2, 3));
  const auto observations = importDepth(import, false);
  EXPECT_EQ(observations.at(0)->cameraParams.fy(), 11.0);
  EXPECT_EQ(observations.at(0)->cameraParams.cy(), 2.25);
}

TEST_F(Import, TumTakesTheIntrinsicsOfTheCameraInTheFoldersName) {
  addImage("rgbd_dataset_freiburg2_desk/depth/a.png");
  addText("rgbd_dataset_freiburg2_desk/depth.txt", "1 depth/a.png\n");
  const ImportPlan import =
      planImport(DatasetFormat::kTum, folder_ / "rgbd_dataset_freiburg2_desk");
  EXPECT_EQ(import.intrinsics.fx, 520.9);
  EXPECT_EQ(import.notes.at(0), "intrinsics: tum-fr2");
  EXPECT_TRUE(import.ground_truth.empty());
  // A 640 × 480 camera cannot have made these 8 × 6 pixels.
  EXPECT_THROW(runImport(import, rawlog(), {}), std::runtime_error);
  EXPECT_TRUE(output_.contents().empty());
}

TEST_F(Import, TumNamesMissingImagesOrLeavesThemOut) {
  addImage("depth/a.png");
  addText("depth.txt", "1 depth/a.png\n2 depth/gone.png\n");
  EXPECT_NE(planError(DatasetFormat::kTum).find("gone.png: missing"), std::string::npos);
  ImportOptions options;
  options.skip_missing = true;
  const ImportPlan import = plan(DatasetFormat::kTum, options);
  EXPECT_EQ(import.frames.size(), 1u);
  EXPECT_EQ(import.missing.at(0), (folder_ / "depth/gone.png").string());
}

TEST_F(Import, TumListsThatAreMissingOrWrongAreErrors) {
  EXPECT_NE(planError(DatasetFormat::kTum).find("depth.txt: missing"), std::string::npos);
  addText("depth.txt", "# nothing\n");
  EXPECT_NE(planError(DatasetFormat::kTum).find("lists no depth image"), std::string::npos);
  addText("depth.txt", "x depth/a.png\n");
  EXPECT_NE(planError(DatasetFormat::kTum).find("depth.txt:1: expected"), std::string::npos);
  addImage("depth/a.png");
  addText("depth.txt", "2 depth/a.png\n1 depth/a.png\n");
  EXPECT_NE(planError(DatasetFormat::kTum).find("depth.txt:2: the times do not ascend"),
            std::string::npos);
}

TEST_F(Import, IclNuimIsTurnedOverSoThatTheFocalLengthIsPositive) {
  for (const char* name : {"depth/0.png", "depth/1.png", "depth/2.png"}) addImage(name);
  addText("traj0.gt.freiburg", "1 0 0 -2.25 0 0 0 1\n2 0 0 -2 0 0 0 1\n");
  ImportOptions options;
  options.intrinsics = CameraIntrinsics{10.0, -11.0, 3.5, 2.25};
  options.start_time = 50.0;
  const ImportPlan import = plan(DatasetFormat::kIclNuim, options);
  const auto observations = importDepth(import, true);
  EXPECT_EQ(observations.at(0)->cameraParams.fy(), 11.0);
  EXPECT_EQ(observations.at(0)->cameraParams.cy(), kHeight - 1 - 2.25);
  EXPECT_NEAR(import.frames.at(2).timestamp, 50.0 + 2.0 / 30.0, 1e-12);
  ASSERT_EQ(import.ground_truth.size(), 2u);
  EXPECT_EQ(import.ground_truth[0].timestamp, import.frames[1].timestamp);
  // As in ../shared/data: an optical frame equal to the map's is the body at (0.5 −0.5 0.5 0.5).
  const Eigen::Quaterniond q(import.ground_truth[0].map_from_body.linear());
  EXPECT_NEAR(std::abs(q.dot(Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5))), 1.0, 1e-12);
  EXPECT_EQ(planImport(DatasetFormat::kIclNuim, folder_.path()).intrinsics.fy, -480.0);
}

TEST_F(Import, IclPixelsLieOnTheSameRaysAsInTheSet) {
  // Through a camera with negative fy the pixel (u, v) of depth z is the optical point
  // z·((u − cx)/fx, (v − cy)/fy, 1); the rawlog must say the same of the turned pixel.
  addImage("depth/0.png");
  const CameraIntrinsics set{10.0, -11.0, 3.5, 2.25};
  ImportOptions options;
  options.intrinsics = set;
  const auto observation = importDepth(plan(DatasetFormat::kIclNuim, options), true).at(0);
  for (int v = 0; v < kHeight; ++v) {
    const int turned = kHeight - 1 - v;
    const double y_of_set = (v - set.cy) / set.fy;
    const double y_of_rawlog =
        (turned - observation->cameraParams.cy()) / observation->cameraParams.fy();
    EXPECT_NEAR(y_of_set, y_of_rawlog, 1e-12);
  }
}

TEST_F(Import, SevenScenesReadsAPoseForEachFrameAndNamesGaps) {
  addImage("frame-000000.depth.png");
  addImage("frame-000001.depth.png");
  addText("frame-000000.color.png", "not looked at");
  addText("frame-000000.pose.txt", "1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  addText("frame-000001.pose.txt", "1 0 0 nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const ImportPlan import = plan(DatasetFormat::kSevenScenes);
  EXPECT_EQ(import.range_unit, 0.001);
  ASSERT_EQ(import.ground_truth.size(), 1u);
  EXPECT_EQ(import.ground_truth[0].map_from_body.translation().x(), 0.5);
  EXPECT_EQ(import.notes.size(), 1u);  // the lost pose
  importDepth(import, false);
  addImage("frame-000005.depth.png");
  EXPECT_NE(
      planError(DatasetFormat::kSevenScenes).find("number 2 to 4 missing before frame-000005"),
      std::string::npos);
  addText("frame-000001.pose.txt", "2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  ImportOptions options;
  options.skip_missing = true;
  EXPECT_NE(planError(DatasetFormat::kSevenScenes, options).find("is no rotation"),
            std::string::npos);
}

TEST_F(Import, RedwoodReadsItsLogOfMatrices) {
  addImage("depth/00000.png");
  addImage("depth/00001.png");
  addText("x-traj.txt",
          "0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n"
          "1 1 2\n1 0 0 4\n0 1 0 5\n0 0 1 6\n0 0 0 1\n");
  const ImportPlan import = plan(DatasetFormat::kRedwood);
  ASSERT_EQ(import.ground_truth.size(), 2u);
  EXPECT_EQ(import.ground_truth[1].map_from_body.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(import.ground_truth[1].timestamp, import.frames[1].timestamp);
  EXPECT_TRUE(import.notes.empty());
  importDepth(import, false);
  addText("x-traj.txt", "0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n");
  EXPECT_NE(plan(DatasetFormat::kRedwood).notes.at(0).find("has 1 poses for 2 frames"),
            std::string::npos);
  addText("x-traj.txt", "1 0 0 1\n");
  EXPECT_NE(planError(DatasetFormat::kRedwood).find("pose 0"), std::string::npos);
  addText("y.log", "");
  EXPECT_NE(planError(DatasetFormat::kRedwood).find("--poses"), std::string::npos);
}

TEST_F(Import, KittiKeepsPointsBitForBitAndTurnsCameraPosesIntoThoseOfTheLidar) {
  std::vector<std::vector<float>> scans;
  for (const char* name : {"velodyne/000000.bin", "velodyne/000001.bin"}) {
    std::vector<float> floats;
    for (int k = 0; k < 40; ++k) floats.push_back(static_cast<float>(random_.uniform(-80, 80)));
    addText(name, std::string(reinterpret_cast<const char*>(floats.data()),
                              floats.size() * sizeof(float)));
    scans.push_back(floats);
  }
  addText("times.txt", "0.0\n1.037e-01\n");
  // The camera looks along the lidar's x and sits 0.3 m before it.
  addText("calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.3\n");
  addText("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n");
  ImportOptions options;
  options.start_time = 1000.0;
  const ImportPlan import = plan(DatasetFormat::kKitti, options);
  ASSERT_EQ(import.ground_truth.size(), 2u);
  EXPECT_TRUE(import.ground_truth[0].map_from_body.isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  EXPECT_TRUE(
      import.ground_truth[1].map_from_body.translation().isApprox(Eigen::Vector3d(2, 0, 0), 1e-12));
  EXPECT_NEAR(import.frames.at(1).timestamp, 1000.1037, 1e-9);
  runImport(import, rawlog(), {});
  const auto observations = readAll<CObservationPointCloud>(rawlog());
  ASSERT_EQ(observations.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_EQ(observations[k]->pointcloud->size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
      float x = 0, y = 0, z = 0;
      observations[k]->pointcloud->getPointFast(i, x, y, z);
      EXPECT_EQ(x, scans[k][4 * i]);
      EXPECT_EQ(y, scans[k][4 * i + 1]);
      EXPECT_EQ(z, scans[k][4 * i + 2]);
    }
  }
  addText("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  const ImportPlan short_poses = plan(DatasetFormat::kKitti, options);
  EXPECT_EQ(short_poses.ground_truth.size(), 1u);
  EXPECT_NE(short_poses.notes.at(0).find("scans from number 1 on have no true pose"),
            std::string::npos);
  addText("velodyne/000001.bin", "17 bytes of chars");
  EXPECT_THROW(runImport(import, rawlog(), {}), std::runtime_error);
  fs::remove(folder_ / "calib.txt");
  EXPECT_NE(planError(DatasetFormat::kKitti).find("calib.txt: missing"), std::string::npos);
}

TEST_F(Import, CloudSeriesKeepPointsBitForBitAndTakeTimesFromNames) {
  for (const std::string& extension : {std::string(".ply"), std::string(".pcd")}) {
    const fs::path series = folder_ / extension.substr(1);
    fs::create_directories(series);
    PointCloud cloud;
    std::string pcd =
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 20\n"
        "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 20\nDATA binary\n";
    for (int k = 0; k < 20; ++k) cloud.points.push_back(random_.vector(50.0).cast<float>());
    cloud.points[3].x() = std::numeric_limits<float>::quiet_NaN();
    for (const auto& point : cloud.points) {
      pcd.append(reinterpret_cast<const char*>(point.data()), 3 * sizeof(float));
    }
    for (const char* name : {"12.5", "13.25"}) {
      const fs::path file = series / (name + extension);
      if (extension == ".ply") writeLabeledPly(file, cloud, std::vector<int>(20, 0));
      if (extension == ".pcd") test::writeFile(file, pcd);
    }
    const ImportPlan import =
        planImport(extension == ".ply" ? DatasetFormat::kPly : DatasetFormat::kPcd, series);
    ASSERT_EQ(import.frames.size(), 2u);
    EXPECT_EQ(import.frames[0].timestamp, 12.5);
    EXPECT_EQ(import.frames[1].timestamp, 13.25);
    runImport(import, rawlog(), {});
    const auto observations = readAll<CObservationPointCloud>(rawlog());
    ASSERT_EQ(observations.size(), 2u);
    ASSERT_EQ(observations[1]->pointcloud->size(), 19u);
    for (std::size_t i = 0; i < 19; ++i) {
      Eigen::Vector3f point;
      observations[1]->pointcloud->getPointFast(i, point.x(), point.y(), point.z());
      EXPECT_EQ(point, cloud.points[i < 3 ? i : i + 1]);
    }
  }
}

TEST_F(Import, CloudSeriesWithoutTimesCountFramesByTheLastNumber) {
  addText("lidar2_0007.pcd", "");
  addText("lidar2_0008.pcd", "");
  addText("poses.tum", "1 0 0 0 0 0 0 1\n");
  ImportOptions options;
  options.start_time = 100.0;
  options.poses = folder_ / "poses.tum";
  const ImportPlan import = plan(DatasetFormat::kPcd, options);
  ASSERT_EQ(import.frames.size(), 2u);
  EXPECT_NEAR(import.frames[0].timestamp, 100.7, 1e-9);
  EXPECT_EQ(import.ground_truth.size(), 1u);
  EXPECT_THROW(runImport(import, rawlog(), {}), std::runtime_error);  // the files are no clouds
  addText("lidar2_0010.pcd", "");
  EXPECT_NE(planError(DatasetFormat::kPcd).find("number 9 missing before lidar2_0010.pcd"),
            std::string::npos);
}

TEST_F(Import, DamagedOrWrongImagesAreNamedAndLeaveNoRawlog) {
  addImage("depth/0.png");
  const ImportPlan import = plan(DatasetFormat::kIclNuim);
  const std::string good = test::readFile(folder_ / "depth/0.png");
  test::writeGrayPng(folder_ / "eight.png", kWidth, kHeight, randomPixels(random_), 8);
  for (const std::string& bad : {good.substr(0, good.size() / 2), std::string("no image"),
                                 std::string(), test::readFile(folder_ / "eight.png")}) {
    addText("depth/0.png", bad);
    try {
      runImport(import, rawlog(), {});
      ADD_FAILURE() << "accepted";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("0.png"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(output_.contents().empty());
  }
}

TEST_F(Import, RandomBytesInAnImageNeverCrash) {
  addImage("0.png");
  const std::string good = test::readFile(folder_ / "0.png");
  for (int k = 0; k < 200; ++k) {
    std::string bytes = good;
    for (int i = 0; i < 3; ++i) {
      const auto at =
          static_cast<std::size_t>(random_.integer(0, static_cast<int>(bytes.size()) - 1));
      bytes[at] = static_cast<char>(random_.integer(0, 255));
    }
    addText("0.png", bytes);
    try {
      const Gray16Image image = readGray16Png(folder_ / "0.png");
      EXPECT_EQ(image.pixels.size(), static_cast<std::size_t>(image.width * image.height));
    } catch (const std::runtime_error&) {
    }
  }
}

TEST_F(Import, FoldersThatAreMissingOrEmptyAreErrors) {
  for (const auto format :
       {DatasetFormat::kTum, DatasetFormat::kIclNuim, DatasetFormat::kSevenScenes,
        DatasetFormat::kRedwood, DatasetFormat::kKitti}) {
    EXPECT_NE(planError(format).find(folder_.path().string()), std::string::npos);
    EXPECT_THROW(planImport(format, folder_ / "no"), std::runtime_error);
  }
}

TEST(Intrinsics, AreNamesOrNumbers) {
  EXPECT_EQ(intrinsicsFromText("tum-fr1").cy, 255.3);
  EXPECT_EQ(intrinsicsFromText("481.2,-480,319.5,239.5").fy, -480.0);
  for (const char* bad : {"", "kinect", "1,2,3", "1,2,3,4,5", "1,2,3,x", "0,1,2,3", "1,nan,2,3"}) {
    EXPECT_THROW(intrinsicsFromText(bad), std::invalid_argument) << bad;
  }
}

TEST(DatasetFormat, UnknownNamesAndOptionsOutOfRangeAreErrors) {
  EXPECT_EQ(datasetFormatFromName("kitti"), DatasetFormat::kKitti);
  EXPECT_THROW(datasetFormatFromName("bag"), std::invalid_argument);
  ImportOptions options;
  options.rate = 0.0;
  EXPECT_THROW(planImport(DatasetFormat::kTum, ".", options), std::invalid_argument);
  options.rate.reset();
  options.range_unit = -1.0;
  EXPECT_THROW(planImport(DatasetFormat::kTum, ".", options), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
