// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/normal_space_sampling.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace opp::mapping {
namespace {

OrientedCloud cloudOf(const std::vector<Eigen::Vector3f>& normals) {
  OrientedCloud cloud;
  cloud.normals = normals;
  cloud.points.assign(normals.size(), Eigen::Vector3f::Zero());
  cloud.sigmas.assign(normals.size(), 0.001F);
  cloud.weights.assign(normals.size(), 1.0F);
  return cloud;
}

TEST(SampleNormalSpace, KeepsTheFewThatFaceAnOddWay) {
  std::vector<Eigen::Vector3f> normals(1000, Eigen::Vector3f::UnitZ());
  for (std::size_t k = 0; k < 30; ++k) normals[33 * k] = Eigen::Vector3f::UnitX();
  const std::vector<std::uint32_t> chosen = sampleNormalSpace(cloudOf(normals), 100);
  EXPECT_EQ(chosen.size(), 100U);
  EXPECT_EQ(std::count_if(chosen.begin(), chosen.end(),
                          [&](std::uint32_t i) { return normals[i].x() > 0.5F; }),
            30);
}

TEST(SampleNormalSpace, ReturnsDistinctAscendingIndicesUpToTheCap) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    std::vector<Eigen::Vector3f> normals;
    const int count = random.integer(0, 3000);
    for (int i = 0; i < count; ++i) normals.push_back(random.unitVector().cast<float>());
    const auto cap = static_cast<std::size_t>(random.integer(1, 2000));
    const std::vector<std::uint32_t> chosen = sampleNormalSpace(cloudOf(normals), cap);
    EXPECT_EQ(chosen.size(), std::min(cap, normals.size()));
    EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
    EXPECT_EQ(std::adjacent_find(chosen.begin(), chosen.end()), chosen.end());
    EXPECT_EQ(chosen, sampleNormalSpace(cloudOf(normals), cap));
  }
}

TEST(SampleNormalSpace, SharesTheCapEvenlyBetweenLargeGroups) {
  std::vector<Eigen::Vector3f> normals(900, Eigen::Vector3f::UnitZ());
  for (std::size_t k = 0; k < 300; ++k) normals[3 * k] = -Eigen::Vector3f::UnitZ();
  const std::vector<std::uint32_t> chosen = sampleNormalSpace(cloudOf(normals), 200);
  EXPECT_EQ(std::count_if(chosen.begin(), chosen.end(),
                          [&](std::uint32_t i) { return normals[i].z() < 0.0F; }),
            100);
}

TEST(SampleNormalSpace, EmptyCloudGivesNothing) {
  EXPECT_TRUE(sampleNormalSpace(OrientedCloud{}, 10).empty());
}

}  // namespace
}  // namespace opp::mapping
