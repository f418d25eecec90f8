// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/dense/occupancy_map.h"

#include "support/random.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace opp::mapping {
namespace {

/// Scans from inside of a box room of 6 × 4 × 3 m with random directions.
std::vector<OccupancyScan> roomScans(test::Random& random, int count, int points) {
  const Eigen::Vector3d half(3.0, 2.0, 1.5);
  std::vector<OccupancyScan> scans;
  for (int k = 0; k < count; ++k) {
    OccupancyScan scan;
    const Eigen::Vector3d origin = 0.5 * half.cwiseProduct(random.vector(1.0));
    scan.origin_in_map = origin.cast<float>();
    for (int i = 0; i < points; ++i) {
      const Eigen::Vector3d direction = random.unitVector();
      double range = std::numeric_limits<double>::max();
      for (int axis = 0; axis < 3; ++axis) {
        const double wall = std::copysign(half[axis], direction[axis]);
        range = std::min(range, (wall - origin[axis]) / direction[axis]);
      }
      scan.points_in_map.push_back(
          (origin + (range + random.normal(0.02)) * direction).cast<float>());
    }
    scans.push_back(scan);
  }
  return scans;
}

octomap::OcTree octomapOf(const std::vector<OccupancyScan>& scans, const OccupancyParams& params) {
  octomap::OcTree tree(params.resolution);
  tree.setProbHit(params.hit_probability);
  tree.setProbMiss(params.miss_probability);
  tree.setClampingThresMin(params.min_probability);
  tree.setClampingThresMax(params.max_probability);
  for (const OccupancyScan& scan : scans) {
    octomap::Pointcloud cloud;
    for (const auto& p : scan.points_in_map) {
      if (p.allFinite()) cloud.push_back(p.x(), p.y(), p.z());
    }
    const octomap::point3d origin(scan.origin_in_map.x(), scan.origin_in_map.y(),
                                  scan.origin_in_map.z());
    tree.insertPointCloud(cloud, origin, params.max_range, false, true);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  return tree;
}

std::string fullTreeOf(const OccupancyMap& map, const test::TempFolder& folder) {
  map.write(folder / "map.ot", folder / "map.bt");
  return test::readFile(folder / "map.ot");
}

TEST(OccupancyMap, EqualsOctomapBitForBit) {
  test::Random random(1);
  const test::TempFolder folder;
  for (int k = 0; k < 50; ++k) {
    OccupancyParams params;
    params.resolution = random.uniform(0.1, 0.4);
    // Every other map cuts rays short, so that some end in free space.
    if (k % 2 == 0) params.max_range = random.uniform(1.0, 3.0);
    const auto scans = roomScans(random, 8, 200);
    OccupancyMap map(params);
    map.insertScans(scans, 2);
    octomap::OcTree expected = octomapOf(scans, params);
    std::ostringstream full, binary;
    expected.write(full);
    expected.writeBinary(binary);
    EXPECT_TRUE(fullTreeOf(map, folder) == full.str()) << k;
    EXPECT_TRUE(test::readFile(folder / "map.bt") == binary.str()) << k;
  }
}

TEST(OccupancyMap, IsTheSameForEveryThreadCountAndEveryBatch) {
  test::Random random(2);
  const test::TempFolder folder;
  const auto scans = roomScans(random, 40, 100);
  OccupancyMap reference{OccupancyParams()};
  reference.insertScans(scans, 1);
  const std::string bytes = fullTreeOf(reference, folder);
  for (const int threads : {0, 2, 7}) {
    OccupancyMap map{OccupancyParams()};
    map.insertScans(scans, threads);
    EXPECT_TRUE(fullTreeOf(map, folder) == bytes) << threads;
  }
  OccupancyMap one_by_one{OccupancyParams()};
  for (const OccupancyScan& scan : scans) one_by_one.insertScans({scan}, 2);
  EXPECT_TRUE(fullTreeOf(one_by_one, folder) == bytes);
}

TEST(OccupancyMap, KnowsHitsMissesAndTheUnseen) {
  OccupancyMap map{OccupancyParams()};
  map.insertScans({{{{2.0F, 0.0F, 0.0F}}, {0.0F, 0.0F, 0.0F}}}, 1);
  EXPECT_NEAR(map.occupancyAt({2.01, 0.01, 0.01}).value(), 0.7, 1e-6);
  EXPECT_NEAR(map.occupancyAt({1.0, 0.01, 0.01}).value(), 0.4, 1e-6);
  EXPECT_FALSE(map.occupancyAt({2.5, 0.0, 0.0}).has_value());
  EXPECT_FALSE(map.occupancyAt({1e6, 0.0, 0.0}).has_value());
}

TEST(OccupancyMap, PassesOverWhatCannotBeInserted) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  OccupancyMap map{OccupancyParams()};
  map.insertScans(
      {{{{nan, 0.0F, 0.0F}, {1e6F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}}, {0.0F, 0.0F, 0.0F}},
       {{{1.0F, 0.0F, 0.0F}}, {nan, 0.0F, 0.0F}},
       {{}, {1e30F, 0.0F, 0.0F}}},
      1);
  EXPECT_EQ(map.pointsPassedOver(), 3U);
  EXPECT_TRUE(map.occupancyAt({1.01, 0.01, 0.01}).has_value());
}

TEST(OccupancyMap, FilesOpenInOctomapsOwnTools) {
  test::Random random(3);
  const test::TempFolder folder;
  OccupancyMap map{OccupancyParams()};
  map.insertScans(roomScans(random, 3, 500), 2);
  map.write(folder / "map.ot", folder / "map.bt");
  const std::unique_ptr<octomap::AbstractOcTree> tree(
      octomap::AbstractOcTree::read((folder / "map.ot").string()));
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->getTreeType(), "OcTree");
  octomap::OcTree binary(1.0);
  ASSERT_TRUE(binary.readBinary((folder / "map.bt").string()));
  EXPECT_DOUBLE_EQ(binary.getResolution(), 0.05);
  for (const char* name : {"map.ot", "map.bt"}) {
    const auto result = test::runCommand({"convert_octree", name, "copy.ot"}, folder.path());
    EXPECT_EQ(result.exit_code, 0) << result;
    EXPECT_GT(test::readFile(folder / "copy.ot").size(), 1000U);
  }
  EXPECT_EQ(test::runCommand({"bt2vrml", "map.bt"}, folder.path()).exit_code, 0);
}

TEST(OccupancyMap, EmptyMapIsAFileToo) {
  const test::TempFolder folder;
  const OccupancyMap map{OccupancyParams()};
  map.write(folder / "map.ot", folder / "map.bt");
  EXPECT_NE(test::readFile(folder / "map.ot").find("size 0"), std::string::npos);
  EXPECT_THROW(map.write("/nowhere/map.ot", "/nowhere/map.bt"), std::runtime_error);
  OccupancyParams bad;
  bad.resolution = 0.0;
  EXPECT_THROW(OccupancyMap{bad}, std::invalid_argument);
}

TEST(OccupancyScan, MovesPointsAndViewpoint) {
  test::Random random(4);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d map_from_body = random.pose(3.0);
    const Eigen::Vector3f point = random.vector(2.0).cast<float>();
    const OccupancyScan scan = occupancyScan({point}, point, map_from_body);
    const Eigen::Vector3d expected = map_from_body * point.cast<double>();
    EXPECT_LT((scan.points_in_map[0].cast<double>() - expected).norm(), 1e-6);  // float rounding
    EXPECT_EQ(scan.origin_in_map, scan.points_in_map[0]);
  }
}

}  // namespace
}  // namespace opp::mapping
