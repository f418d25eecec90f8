// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/cloud/oriented_cloud.h"

#include "support/depth_image.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using test::Camera;
using test::Random;

constexpr Camera kSmallCamera{120, 160, 131.25};  // a Kinect's field of view, a quarter of its rows

/// Three orthogonal planes through `corner`, normals turned to a viewer at the origin. At the
/// corner each is seen at 70 degrees or steeper: a camera of 160 columns does not resolve an edge
/// of a surface of which it sees little more than one row of pixels.
std::vector<Plane> cornerFacingOrigin(Random& random, const Vector3d& corner) {
  for (;;) {
    const Eigen::Matrix3d rotation = random.rotation();
    std::vector<Plane> planes;
    double grazing = 1.0;
    for (int k = 0; k < 3; ++k) {
      const Plane plane = Plane::fromPointNormal(corner, rotation.col(k));
      planes.push_back(plane.d() < 0.0 ? plane.flipped() : plane);
      grazing = std::min(grazing, planes.back().d() / corner.norm());
    }
    if (grazing > std::cos(degToRad(70.0))) return planes;
  }
}

SensorModel idealSensor() {
  SensorModel sensor;
  sensor.noise_constant = 1e-6;
  sensor.noise_quadratic = 0.0;
  sensor.max_range = 4.0;
  return sensor;
}

double normalError(const OrientedCloud& cloud, std::size_t i, const Plane& plane) {
  const Vector3d normal = cloud.normals[i].cast<double>();
  return std::atan2(normal.cross(plane.normal()).norm(), normal.dot(plane.normal()));
}

void expectSound(const OrientedCloud& cloud) {
  ASSERT_EQ(cloud.normals.size(), cloud.size());
  ASSERT_EQ(cloud.sigmas.size(), cloud.size());
  ASSERT_EQ(cloud.weights.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_TRUE(cloud.points[i].allFinite());
    ASSERT_NEAR(cloud.normals[i].cast<double>().norm(), 1.0, 1e-6);  // rounding of three floats
    ASSERT_TRUE(std::isfinite(cloud.sigmas[i]) && cloud.sigmas[i] > 0.0F);
    ASSERT_TRUE(std::isfinite(cloud.weights[i]) && cloud.weights[i] >= 1.0F);
    // A plane through the viewpoint has no side; rounding decides.
    const Vector3d to_viewpoint = (cloud.viewpoint - cloud.points[i]).cast<double>();
    ASSERT_GE(cloud.normals[i].cast<double>().dot(to_viewpoint), -1e-5 * to_viewpoint.norm());
  }
}

TEST(ScanSurface, OpenSamplesAreSplitIntoTheirPatches) {
  Random random(11);
  for (int trial = 0; trial < 50; ++trial) {
    const auto planes = cornerFacingOrigin(random, {random.uniform(1.0, 3.0), 0.0, 0.0});
    const PointCloud input = test::renderDepth(kSmallCamera, test::insideOf(planes));
    SamplingParams params;
    params.target_samples = 500;
    ScanSurface surface = makeScanSurface(input, idealSensor(), params);
    ASSERT_EQ(surface.sample_of_patch.size(), surface.patches.size());
    std::vector<std::uint8_t> open(surface.samples.size());
    for (std::uint8_t& flag : open) flag = random.uniform(0.0, 1.0) < 0.3 ? 1 : 0;
    double points = 0.0;
    std::size_t split = 0, kept = 0;
    for (const float weight : surface.samples.weights) points += static_cast<double>(weight);
    for (const int sample : surface.sample_of_patch) {
      split += open[static_cast<std::size_t>(sample)];
    }
    for (const std::uint8_t flag : open) kept += flag == 0 ? 1 : 0;
    EXPECT_EQ(splitSamples(surface, open), kept);
    EXPECT_EQ(surface.samples.size(), kept + split);
    EXPECT_EQ(surface.patches.size(), 0U);
    expectSound(surface.samples);
    for (std::size_t i = 0; i < surface.samples.size(); ++i) {
      points -= static_cast<double>(surface.samples.weights[i]);
      ASSERT_GT(surface.samples.extent(i), 0.0);
      ASSERT_LE(surface.samples.extent(i), surface.samples.spacing * 1.000001);
      ASSERT_GT(surface.samples.patchExtent(i), 0.0);
      ASSERT_LE(surface.samples.patchExtent(i), surface.samples.extent(i) * 1.000001);
    }
    EXPECT_EQ(points, 0.0) << "every raw point stays in one sample; sums of whole numbers";
  }
}

TEST(ScanSurface, PatchesStandForTheSurfaceTheyCover) {
  // A wall of 4 m² seen frontally from 2 m by a camera that sees all of it and nothing else.
  const Plane wall = Plane::fromPointNormal({2.0, 0.0, 0.0}, {-1.0, 0.0, 0.0});
  const Camera camera{100, 100, 100.0};
  const PointCloud input = test::renderDepth(camera, test::insideOf({wall}));
  const ScanSurface surface = makeScanSurface(input, idealSensor(), SamplingParams{});
  double area = 0.0;
  for (std::size_t i = 0; i < surface.patches.size(); ++i) {
    area += surface.patches.extent(i) * surface.patches.extent(i);
  }
  // Angles between rays are the image centre's in the median, 15 % smaller at its rim.
  EXPECT_NEAR(area, 4.0, 0.4);
}

TEST(ScanSurface, ShowsHowFarNoiseIsCorrelated) {
  Random random(12);
  const Plane wall = Plane::fromPointNormal({2.0, 0.0, 0.0}, {-1.0, 0.2, 0.1});
  PointCloud input = test::renderDepth(Camera{}, test::insideOf({wall}));
  test::addRangeNoise(input, SensorModel{}, random);
  const ScanSurface independent = makeScanSurface(input, SensorModel{}, SamplingParams{});
  EXPECT_GE(independent.samples.noise_correlation, 0.0);
  EXPECT_LT(independent.samples.noise_correlation, 0.02);
  // Blocks of 4 × 4 pixels, which are the patches, err alike: as if all their errors were one.
  for (int row = 0; row < 480; ++row) {
    for (int col = 0; col < 640; ++col) {
      const auto at = static_cast<std::size_t>(row * 640 + col);
      const auto first = static_cast<std::size_t>(row / 4 * 4 * 640 + col / 4 * 4);
      const Vector3f along = input.points[at].normalized();
      const double range = wall.d() / -wall.normal().dot(along.cast<double>());
      const double error =
          input.points[first].cast<double>().norm() -
          wall.d() / -wall.normal().dot(input.points[first].cast<double>().normalized());
      if (at != first) input.points[at] = static_cast<float>(range + error) * along;
    }
  }
  const ScanSurface correlated = makeScanSurface(input, SensorModel{}, SamplingParams{});
  // Noise above three times the model's is taken for structure: 9 of 16.
  EXPECT_GT(correlated.samples.noise_correlation, 0.4);
  const SensorModel sensor;
  EXPECT_EQ(sensor.withCorrelation(0.4).noise_correlation, sensor.noise_correlation);
  EXPECT_EQ(sensor.withCorrelation(0.01).noise_correlation, 0.01);
  EXPECT_EQ(sensor.withCorrelation(-1.0).noise_correlation, sensor.noise_correlation);
}

TEST(OrientedCloud, SamplesOfANoiseFreePlaneLieOnIt) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Vector3d point(random.uniform(1.0, 4.0), 0.0, 0.0);
    Vector3d normal = random.unitVector();
    normal.x() = -std::abs(normal.x()) - 0.3;
    const Plane plane = Plane::fromPointNormal(point, normal);
    const PointCloud input = test::renderDepth(kSmallCamera, test::insideOf({plane}));
    const OrientedCloud cloud = makeOrientedCloud(input, SensorModel{}, SamplingParams{});
    expectSound(cloud);
    ASSERT_GT(cloud.size(), 1000U);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      // Coordinates up to 6 m are rounded to 2.4e-7 m; a window spans at least 1 cm.
      ASSERT_NEAR(plane.signedDistance(cloud.points[i].cast<double>()), 0.0, 1e-6);
      ASSERT_LT(normalError(cloud, i, plane), 1e-4);
    }
  }
}

TEST(OrientedCloud, NormalErrorStaysWithinItsBoundUnderKinectNoise) {
  Random random(2);
  const SensorModel sensor;
  const SamplingParams params;
  std::size_t samples = 0;
  std::size_t gross = 0;
  double squares = 0.0;
  for (int trial = 0; trial < 50; ++trial) {
    Vector3d normal = random.unitVector();
    normal.x() = -std::abs(normal.x()) - 0.5;
    const Plane plane = Plane::fromPointNormal(Vector3d(random.uniform(0.6, 4.0), 0, 0), normal);
    PointCloud input = test::renderDepth(kSmallCamera, test::insideOf({plane}));
    test::addRangeNoise(input, sensor, random);
    const OrientedCloud cloud = makeOrientedCloud(input, sensor, params);
    expectSound(cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const double error = normalError(cloud, i, plane);
      squares += error * error;
      gross += error > 4.0 * params.normal_error ? 1 : 0;
    }
    samples += cloud.size();
  }
  ASSERT_GT(samples, 20000U);
  // The bound holds per direction, a normal has two.
  EXPECT_LT(std::sqrt(squares / static_cast<double>(samples)),
            std::sqrt(2.0) * params.normal_error);
  EXPECT_LT(static_cast<double>(gross), 1e-3 * static_cast<double>(samples));
}

TEST(OrientedCloud, OffsetsOfSamplesHaveTheStatedStandardDeviation) {
  Random random(3);
  SensorModel sensor;
  sensor.max_range = 20.0;  // noise at the gate would keep the near half of the points only
  SamplingParams params;
  params.lateral_noise = 0.0;  // none is drawn
  double squares = 0.0;
  std::size_t samples = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Plane plane =
        Plane::fromPointNormal(Vector3d(random.uniform(1.0, 3.0), 0, 0), Vector3d(-1, 0.5, 0.3));
    PointCloud input = test::renderDepth(kSmallCamera, test::insideOf({plane}));
    test::addRangeNoise(input, sensor, random);
    const OrientedCloud cloud = makeOrientedCloud(input, sensor, params);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const double error = plane.signedDistance(cloud.points[i].cast<double>());
      squares += error * error * static_cast<double>(cloud.weights[i]) /
                 static_cast<double>(cloud.sigmas[i] * cloud.sigmas[i]);
      ++samples;
    }
  }
  // The constant part of the noise is drawn along the ray here and counted in all directions there.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(samples)), 1.0, 0.05);
}

TEST(OrientedCloud, SurfacesAtTheEndOfTheRangeAreWhereTheyAre) {
  // A wall with noise of 54 mm at 6 m: of one right there the half that is left is 43 mm too near.
  const SensorModel sensor;
  Random random(6);
  for (double distance = 5.6; distance < 6.15; distance += 0.04) {
    PointCloud cloud =
        test::renderDepth({}, [&](const Vector3d& ray) { return distance / ray.x(); });
    test::addRangeNoise(cloud, sensor, random);
    const OrientedCloud samples = makeOrientedCloud(cloud, sensor, SamplingParams());
    double mean = 0.0, count = 0.0;
    for (const Vector3f& point : samples.points) mean += point.x(), count += 1.0;
    EXPECT_TRUE(distance < 5.7 ? count > 50.0 : distance < 6.0 || count == 0.0) << distance;
    if (count < 50.0) continue;
    // Patches are chosen by their own means, whose noise is a third: 14 mm at most are left.
    EXPECT_NEAR(mean / count, distance, 0.016) << distance;
  }
}

TEST(OrientedCloud, NormalsAreNotMixedAtCorners) {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Vector3d corner(random.uniform(1.5, 3.0), random.uniform(-0.5, 0.5),
                          random.uniform(-0.5, 0.5));
    const auto planes = cornerFacingOrigin(random, corner);
    const bool room = trial % 2 == 0;
    const PointCloud input =
        test::renderDepth(kSmallCamera, room ? test::insideOf(planes) : test::outsideOf(planes));
    const OrientedCloud cloud = makeOrientedCloud(input, idealSensor(), SamplingParams{});
    expectSound(cloud);
    std::size_t mixed = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      double error = 10.0;
      for (const Plane& plane : planes) error = std::min(error, normalError(cloud, i, plane));
      mixed += error > SamplingParams{}.normal_error ? 1 : 0;
    }
    // Where the range gate cuts a surface, two rows that are left may lie on two planes.
    EXPECT_LE(mixed, cloud.size() / 1000) << "trial " << trial;
  }
}

TEST(OrientedCloud, NoSampleFloatsBetweenForegroundAndBackground) {
  // A board 1.5 m away in front of a wall at 2.5 m.
  const auto scene = [](const Vector3d& ray) {
    const bool board = std::abs(ray.y() / ray.x()) < 0.3 && std::abs(ray.z() / ray.x()) < 0.2;
    return (board ? 1.5 : 2.5) / ray.x();
  };
  Random random(5);
  PointCloud input = test::renderDepth(Camera{}, scene);
  test::addRangeNoise(input, SensorModel{}, random);
  const OrientedCloud cloud = makeOrientedCloud(input, SensorModel{}, SamplingParams{});
  ASSERT_GT(cloud.size(), 1000U);
  for (const Vector3f& point : cloud.points) {
    // Five standard deviations of a single point at the wall.
    const float distance = std::min(std::abs(point.x() - 1.5F), std::abs(point.x() - 2.5F));
    EXPECT_LT(distance, 5.0F * 0.0095F) << point.transpose();
  }
}

TEST(OrientedCloud, UnorganizedCloudGivesTheSameSurfaces) {
  Random random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const auto planes = cornerFacingOrigin(random, Vector3d(random.uniform(1.5, 2.5), 0.1, 0.1));
    PointCloud input = test::renderDepth(kSmallCamera, test::insideOf(planes));
    input.rows = input.cols = 0;
    std::reverse(input.points.begin(), input.points.end());
    const OrientedCloud cloud = makeOrientedCloud(input, idealSensor(), SamplingParams{});
    expectSound(cloud);
    EXPECT_GT(cloud.size(), 1000U);
    std::size_t mixed = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      double error = 10.0;
      for (const Plane& plane : planes) error = std::min(error, normalError(cloud, i, plane));
      mixed += error > SamplingParams{}.normal_error ? 1 : 0;
    }
    // Where the range gate cuts a surface, two rows that are left may lie on two planes.
    EXPECT_LE(mixed, cloud.size() / 1000) << "trial " << trial;
  }
}

TEST(OrientedCloud, SpacingFollowsTheExtent) {
  SensorModel sensor = idealSensor();
  sensor.min_range = 0.0;
  sensor.max_range = 1000.0;
  Random random(7);
  for (const double size : {0.1, 1.0, 10.0, 100.0}) {
    PointCloud input;
    for (int i = 0; i < 40000; ++i) {
      const double y = random.uniform(0.0, size);
      input.points.push_back(Vector3d(size, y, random.uniform(0.0, size)).cast<float>());
    }
    const OrientedCloud cloud = makeOrientedCloud(input, sensor, SamplingParams{});
    expectSound(cloud);
    EXPECT_GT(cloud.size(), 4000U) << size;
    EXPECT_LT(cloud.size(), 12000U) << size;
    EXPECT_NEAR(cloud.spacing / size, 0.835 / std::sqrt(8000.0), 0.001);
  }
}

TEST(OrientedCloud, GivenNormalsAreNormalizedTurnedAndBadOnesDropped) {
  PointCloud input;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < 100; ++i) {
    input.points.push_back(Vector3d(2, 0.1 * (i % 10), 0.1 * (i / 10)).cast<float>());
    input.normals.emplace_back(i % 2 == 0 ? 3.0F : -0.2F, 0.0F, 0.0F);
  }
  input.normals[0] = Vector3f::Zero();
  input.normals[1] = Vector3f(nan, 0, 1);
  input.points[2].x() = nan;
  const OrientedCloud cloud = makeOrientedCloud(input, SensorModel{}, SamplingParams{});
  expectSound(cloud);
  EXPECT_LE(cloud.size(), 97U);
  EXPECT_GE(cloud.size(), 60U);
  for (const Vector3f& normal : cloud.normals) EXPECT_EQ(normal, Vector3f(-1, 0, 0));
}

TEST(OrientedCloud, DegenerateInputGivesAFiniteOrEmptyCloud) {
  Random random(8);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int trial = 0; trial < 300; ++trial) {
    PointCloud input;
    const int count = trial % 5 == 0 ? random.integer(0, 3) : random.integer(4, 400);
    const Vector3d offset = trial % 7 == 0 ? Vector3d(1e6, -1e6, 1e6) : Vector3d(2, 0, 0);
    const Vector3d a = random.vector(1.0), b = random.vector(1.0);
    const int kind = trial % 6;
    for (int i = 0; i < count; ++i) {
      Vector3d point = offset;                                // 0: all equal
      if (kind == 1) point += random.uniform(-1.0, 1.0) * a;  // collinear
      if (kind == 2) point += random.uniform(-1, 1) * a + random.uniform(-1, 1) * b;  // a plane
      if (kind == 3) point += random.vector(1.0);                                     // a cloud
      if (kind == 4) point += i % 2 == 0 ? a : b;                                     // two points
      input.points.push_back(point.cast<float>());
      if (kind == 5) input.points.back() = Vector3f::Constant(nan);
      if (random.integer(0, 9) == 0) input.points.back().y() = nan;
      if (random.integer(0, 9) == 0)
        input.points.back().z() = std::numeric_limits<float>::infinity();
    }
    if (trial % 4 == 1 && count > 0) {
      input.rows = 1;
      input.cols = count;
      input.columns_wrap = trial % 8 == 1;
    }
    if (trial % 4 == 2) input.viewpoint = offset.cast<float>();
    if (trial % 4 == 3) {
      for (int i = 0; i < count; ++i) input.normals.push_back(random.vector(2.0).cast<float>());
    }
    SensorModel sensor;
    sensor.min_range = 0.0;
    if (trial % 7 == 0) sensor.max_range = 1000.0;
    expectSound(makeOrientedCloud(input, sensor, SamplingParams{}));
  }
}

TEST(OrientedCloud, PointsOnALineHaveNoNormals) {
  PointCloud input;
  for (int i = 0; i < 500; ++i)
    input.points.emplace_back(2.0F, 0.01F * static_cast<float>(i), 0.5F);
  EXPECT_EQ(makeOrientedCloud(input, idealSensor(), SamplingParams{}).size(), 0U);
}

TEST(OrientedCloud, RepeatsByteForByte) {
  Random random(9);
  PointCloud input = test::renderDepth(
      kSmallCamera, test::insideOf(cornerFacingOrigin(random, Vector3d(2, 0, 0))));
  test::addRangeNoise(input, SensorModel{}, random);
  const OrientedCloud a = makeOrientedCloud(input, SensorModel{}, SamplingParams{});
  const OrientedCloud b = makeOrientedCloud(input, SensorModel{}, SamplingParams{});
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.sigmas, b.sigmas);
  EXPECT_EQ(a.weights, b.weights);
}

TEST(OrientedCloud, CallersMistakesAreErrors) {
  PointCloud input;
  input.points.assign(6, Vector3f(2, 0, 0));
  input.rows = 2;
  input.cols = 4;
  EXPECT_THROW(makeOrientedCloud(input, SensorModel{}, SamplingParams{}), std::invalid_argument);
  input.rows = input.cols = 0;
  input.normals.assign(5, Vector3f(1, 0, 0));
  EXPECT_THROW(makeOrientedCloud(input, SensorModel{}, SamplingParams{}), std::invalid_argument);
  input.normals.clear();
  SamplingParams params;
  params.target_samples = 0;
  EXPECT_THROW(makeOrientedCloud(input, SensorModel{}, params), std::invalid_argument);
  input.viewpoint.x() = std::numeric_limits<float>::infinity();
  EXPECT_THROW(makeOrientedCloud(input, SensorModel{}, SamplingParams{}), std::invalid_argument);
}

}  // namespace
}  // namespace opp
