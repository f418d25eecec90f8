// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/cloud/even_sampling.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace opp {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using test::Random;

OrientedCloud randomSquare(Random& random, int count, double z, const Vector3f& normal) {
  OrientedCloud cloud;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(0.0, 1.0);
    cloud.points.push_back(Vector3d(x, random.uniform(0.0, 1.0), z).cast<float>());
    cloud.normals.push_back(normal);
    cloud.sigmas.push_back(1e-4F);
    cloud.weights.push_back(1.0F);
  }
  return cloud;
}

void append(OrientedCloud& to, const OrientedCloud& from) {
  to.points.insert(to.points.end(), from.points.begin(), from.points.end());
  to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
  to.sigmas.insert(to.sigmas.end(), from.sigmas.begin(), from.sigmas.end());
  to.weights.insert(to.weights.end(), from.weights.begin(), from.weights.end());
}

TEST(SampleEvenly, TwoNearPointsBecomeTheirWeightedMean) {
  OrientedCloud dense;
  dense.points = {{0, 0, 0}, {0.04F, 0, 0}, {1, 0, 0}};
  dense.normals.assign(3, Vector3f(0, 0, 1));
  dense.sigmas = {0.001F, 0.001F, 0.002F};
  dense.weights = {1, 3, 1};
  const OrientedCloud cloud = sampleEvenly(dense, 0.1, SamplingParams{});
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_TRUE(cloud.points[0].isApprox(Vector3f(0.03F, 0, 0), 1e-6F));
  EXPECT_EQ(cloud.points[1], Vector3f(1, 0, 0));
  EXPECT_EQ(cloud.weights[0], 4.0F);
  EXPECT_NEAR(cloud.sigmas[0], 0.001, 1e-9);
  EXPECT_EQ(cloud.spacing, 0.1);
}

TEST(SampleEvenly, KeepsTotalWeightAndCoversEveryPoint) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const double spacing = random.uniform(0.03, 0.3);
    const OrientedCloud dense = randomSquare(random, 2000, 0.5, Vector3f(0, 0, 1));
    const OrientedCloud cloud = sampleEvenly(dense, spacing, SamplingParams{});
    EXPECT_EQ(std::accumulate(cloud.weights.begin(), cloud.weights.end(), 0.0F), 2000.0F);
    // Discs of half the spacing around the seeds do not overlap: their number is bounded by the
    // area of the square grown by that radius.
    const double bound = std::pow(1.0 + spacing, 2) / (kPi / 4.0 * spacing * spacing);
    EXPECT_LT(static_cast<double>(cloud.size()), bound);
    for (const Vector3f& point : dense.points) {
      float nearest = std::numeric_limits<float>::infinity();
      for (const Vector3f& sample : cloud.points)
        nearest = std::min(nearest, (sample - point).norm());
      // Within `spacing` of a seed, whose mean has moved by less than `spacing`.
      ASSERT_LT(nearest, 2.0 * spacing);
    }
  }
}

TEST(SampleEvenly, DoesNotAverageAcrossSurfaces) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const double gap = random.uniform(0.02, 0.05);
    // Front and far side of a board, a layer above it, and a wall that meets it at x = 0.
    OrientedCloud dense = randomSquare(random, 500, 0.0, Vector3f(0, 0, 1));
    append(dense, randomSquare(random, 500, 0.0, Vector3f(0, 0, -1)));
    append(dense, randomSquare(random, 500, gap, Vector3f(0, 0, 1)));
    OrientedCloud wall = randomSquare(random, 500, 0.0, Vector3f(1, 0, 0));
    for (Vector3f& point : wall.points) point = Vector3f(0, point.y(), point.x());
    append(dense, wall);
    const OrientedCloud cloud = sampleEvenly(dense, 0.1, SamplingParams{});
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vector3f& p = cloud.points[i];
      const float offset =
          cloud.normals[i].x() > 0.5F
              ? std::abs(p.x())
              : std::min(std::abs(p.z()), std::abs(p.z() - static_cast<float>(gap)));
      ASSERT_LT(offset, 1e-6F) << p.transpose();
    }
  }
}

TEST(SampleEvenly, EmptyInputGivesEmptyOutputAndBadSpacingIsAnError) {
  EXPECT_EQ(sampleEvenly(OrientedCloud{}, 0.1, SamplingParams{}).size(), 0U);
  EXPECT_THROW(sampleEvenly(OrientedCloud{}, 0.0, SamplingParams{}), std::invalid_argument);
  EXPECT_THROW(sampleEvenly(OrientedCloud{}, std::nan(""), SamplingParams{}),
               std::invalid_argument);
}

TEST(SpacingForCount, OccupiesAboutAsManyCellsAsAskedFor) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const double scale = std::pow(10.0, random.uniform(-2.0, 3.0));
    const Eigen::Matrix3d rotation = random.rotation();
    std::vector<Vector3f> points;
    for (int i = 0; i < 20000; ++i) {
      const double x = random.uniform(0, scale), y = random.uniform(0, scale);
      points.push_back((rotation * Vector3d(x, y, 0)).cast<float>());
    }
    // A square of area scale² crosses between 1 and 1.74 cells per cell face, by its direction.
    const double edge = spacingForCount(points, 2000, 0.0);
    EXPECT_GT(edge, 0.9 * scale / std::sqrt(2000.0));
    EXPECT_LT(edge, 1.5 * scale / std::sqrt(2000.0));
  }
}

TEST(SpacingForCount, NeverBelowTheMinimum) {
  EXPECT_EQ(spacingForCount({}, 100, 0.25), 0.25);
  EXPECT_EQ(spacingForCount(std::vector<Vector3f>(10, Vector3f(1, 2, 3)), 100, 0.25), 0.25);
  EXPECT_EQ(spacingForCount({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 100, 5.0), 5.0);
}

}  // namespace
}  // namespace opp
