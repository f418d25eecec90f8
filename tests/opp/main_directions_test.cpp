// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/main_directions.h"

#include "opp/geometry/constants.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp {
namespace {

using Eigen::Vector3d;
using test::Random;

TEST(MainDirections, AreTheMeansOfNormalsAndTheirThirdAxis) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Matrix3d axes = random.rotation();
    std::vector<Vector3d> normals;
    for (int k = 0; k < 400; ++k) {
      const double sign = random.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
      const Vector3d off(random.normal(), random.normal(), random.normal());
      normals.push_back((sign * axes.col(k % 4 == 0 ? 1 : 0) + degToRad(3.0) * off).normalized());
    }
    const auto directions = mainDirections(normals);
    ASSERT_EQ(directions.size(), 3U);
    for (int k = 0; k < 3; ++k) {
      // 3° / √100, four times, and for the third axis twice.
      const double cosine = std::abs(directions[static_cast<std::size_t>(k)].dot(axes.col(k)));
      EXPECT_GT(cosine, std::cos(degToRad(2.4)));
    }
  }
}

TEST(MainDirections, NeedEnoughNormals) {
  EXPECT_TRUE(mainDirections({}).empty());
  EXPECT_TRUE(mainDirections(std::vector<Vector3d>(31, Vector3d::UnitZ())).empty());
  const auto one = mainDirections(std::vector<Vector3d>(32, -Vector3d::UnitZ()));
  ASSERT_EQ(one.size(), 1U);
  EXPECT_NEAR(std::abs(one[0].z()), 1.0, 1e-12);
}

}  // namespace
}  // namespace opp
