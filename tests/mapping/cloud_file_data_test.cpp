// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/cloud_file.h"

#include "support/shared_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace opp::mapping {
namespace {

TEST(CloudFileData, ReadsThePointsAndNormalsOfThePaper) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const PointCloud cloud = readCloudFile(test::sharedData("fixtures/icl_nuim_frame.ply"));
  ASSERT_EQ(cloud.size(), 7884U);
  ASSERT_TRUE(cloud.hasNormals());
  // The file keeps means of unit vectors: any length up to one, never zero.
  for (const Eigen::Vector3f& normal : cloud.normals) {
    EXPECT_GT(normal.norm(), 0.0F);
    EXPECT_LT(normal.norm(), 1.001F);
  }
}

TEST(CloudFileData, ReadsGridAndPlanesOfSynPeb) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const LabeledCloud read = readLabeledCloudFile(test::sharedData("fixtures/synpeb_test_500.pcd"));
  EXPECT_EQ(read.cloud.rows, 500);
  EXPECT_EQ(read.cloud.cols, 500);
  const std::set<int> labels(read.labels.begin(), read.labels.end());
  // data/README.md: 38 planes, labels from 10 on.
  EXPECT_EQ(std::distance(labels.lower_bound(10), labels.end()), 38);
}

}  // namespace
}  // namespace opp::mapping
