// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/surfel_map.h"

#include "opp/geometry/constants.h"

#include "support/random.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

const Eigen::Vector3f kUp = Eigen::Vector3f::UnitZ();

SurfelMap makeMap() { return SurfelMap(0.1, degToRad(35.0)); }

TEST(SurfelMap, AveragesWhatFacesTheSameWayInAVoxelByWeight) {
  SurfelMap map = makeMap();
  map.insert({0.02F, 0.05F, 0.050F}, kUp, 1e-4F, -1);
  map.insert({0.06F, 0.05F, 0.054F}, kUp, 1e-4F / 3.0F, -1);
  ASSERT_EQ(map.size(), 1U);
  const Surfel* surfel = map.closest({0.05F, 0.05F, 0.05F}, kUp);
  ASSERT_NE(surfel, nullptr);
  // Weights 1 : 3; float32 arithmetic on values of 0.1 m.
  EXPECT_TRUE(surfel->mean.isApprox(Eigen::Vector3f(0.05F, 0.05F, 0.053F), 1e-6F));
  EXPECT_NEAR(surfel->weight, 4e4F, 1e-1F);
}

TEST(SurfelMap, KeepsTheTwoSidesOfAThinWallApart) {
  SurfelMap map = makeMap();
  for (int k = 0; k < 5; ++k) {
    const float x = 0.01F + 0.02F * static_cast<float>(k);
    map.insert({x, 0.05F, 0.06F}, kUp, 1e-4F, 0);
    map.insert({x, 0.05F, 0.04F}, -kUp, 1e-4F, 1);
  }
  ASSERT_EQ(map.size(), 2U);
  const Eigen::Vector3f middle(0.05F, 0.05F, 0.05F);
  EXPECT_FLOAT_EQ(map.closest(middle, kUp)->mean.z(), 0.06F);
  EXPECT_EQ(map.closest(middle, kUp)->landmark, 0);
  EXPECT_FLOAT_EQ(map.closest(middle, -kUp)->mean.z(), 0.04F);
  EXPECT_EQ(map.closest(middle, -kUp)->landmark, 1);
}

TEST(SurfelMap, KeepsLandmarksApart) {
  SurfelMap map = makeMap();
  map.insert({0.05F, 0.05F, 0.05F}, kUp, 1e-4F, 3);
  map.insert({0.05F, 0.05F, 0.06F}, kUp, 1e-4F, -1);
  EXPECT_EQ(map.size(), 2U);
}

TEST(SurfelMap, FindsEverySurfelWithinHalfAVoxelThatFacesTheSameWay) {
  test::Random random(1);
  for (int k = 0; k < 200; ++k) {
    SurfelMap map = makeMap();
    const Eigen::Vector3f point = random.vector(3.0).cast<float>();
    const Eigen::Vector3f normal = random.unitVector().cast<float>();
    map.insert(point, normal, 1e-4F, -1);
    const Eigen::Vector3f query =
        point + static_cast<float>(random.uniform(0.0, 0.049)) * random.unitVector().cast<float>();
    EXPECT_NE(map.closest(query, normal), nullptr);
    EXPECT_EQ(map.closest(query, -normal), nullptr);
    EXPECT_EQ(map.closest(point + Eigen::Vector3f(0.3F, 0.0F, 0.0F), normal), nullptr);
  }
}

TEST(SurfelMap, SumsTheWeightsOfAllSamplesInUnitNormalSurfels) {
  test::Random random(2);
  SurfelMap map = makeMap();
  std::vector<Eigen::Vector3f> points, normals;
  for (int k = 0; k < 500; ++k) {
    points.push_back(random.vector(0.3).cast<float>());
    normals.push_back(random.unitVector().cast<float>());
    map.insert(points.back(), normals.back(), 1.0F, -1);
  }
  EXPECT_LE(map.size(), points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Surfel* surfel = map.closest(points[k], normals[k]);
    // A sample may face away from the mean that it was merged into by more than the gate.
    if (surfel == nullptr) continue;
    EXPECT_NEAR(surfel->normal.norm(), 1.0F, 1e-5F);
    EXPECT_GE(surfel->weight, 1.0F);
    EXPECT_LE(surfel->weight, 500.0F);
  }
}

TEST(SurfelMap, EmptyHasNothingClose) {
  EXPECT_EQ(makeMap().closest(Eigen::Vector3f::Zero(), kUp), nullptr);
}

}  // namespace
}  // namespace opp::mapping
