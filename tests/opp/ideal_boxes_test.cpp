// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/detect_primitives.h"
#include "opp/geometry/constants.h"

#include "support/depth_image.h"
#include "support/random.h"
#include "support/refined_scene.h"
#include "support/synthetic_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

/// Boxes without noise through all stages, from raw points to corners: what is found must be exact.
namespace opp {
namespace {

/// Far above the rounding of single precision (1e-7 m for one point), far below all thresholds.
constexpr double kTolerance = 1e-6;

/// A box in the cloud's frame.
struct Box {
  Eigen::Vector3d low, high;
  Eigen::Isometry3d cloud_from_box;

  std::vector<Eigen::Vector3d> vertices() const {
    std::vector<Eigen::Vector3d> result;
    for (int k = 0; k < 8; ++k) {
      const Eigen::Vector3d vertex((k & 1) != 0 ? high.x() : low.x(),
                                   (k & 2) != 0 ? high.y() : low.y(),
                                   (k & 4) != 0 ? high.z() : low.z());
      result.push_back(cloud_from_box * vertex);
    }
    return result;
  }
  Plane inCloud(const test::Rectangle& side) const {
    return transformed(cloud_from_box, side.plane());
  }
};

/// A sensor with a noise of 1 µm and no distortion.
PrimitiveParams idealSensor() {
  PrimitiveParams params;
  params.sensor.noise_constant = 1e-6;
  params.sensor.noise_quadratic = 0.0;
  params.sensor.distortion_quadratic = 0.0;
  params.sampling.lateral_noise = 0.0;
  params.refinement.systematic_angle = 0.0;
  return params;
}

double distanceToNearest(const Eigen::Vector3d& x, const std::vector<Eigen::Vector3d>& points) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : points) nearest = std::min(nearest, (x - point).norm());
  return nearest;
}

/// Each of `points` lies on one of `truth`, no two of them on the same.
void expectDistinct(const std::vector<Eigen::Vector3d>& points,
                    const std::vector<Eigen::Vector3d>& truth, double tolerance) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT(distanceToNearest(points[i], truth), tolerance);
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT((points[i] - points[k]).norm(), 0.1);
  }
}

void expectOneExactFrame(const Primitives& found) {
  ASSERT_EQ(found.families.size(), 3U);
  Eigen::Matrix3d frame;
  for (int k = 0; k < 3; ++k) frame.col(k) = found.families[static_cast<std::size_t>(k)].normal;
  EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

/// Middles of the box's twelve edges.
std::vector<Eigen::Vector3d> edgesOf(const Box& box) {
  std::vector<Eigen::Vector3d> middles;
  const Eigen::Vector3d center = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double u : {-1.0, 1.0}) {
      for (const double v : {-1.0, 1.0}) {
        Eigen::Vector3d side = Eigen::Vector3d::Zero();
        side[(axis + 1) % 3] = u, side[(axis + 2) % 3] = v;
        middles.emplace_back(box.cloud_from_box * (center + half.cwiseProduct(side)));
      }
    }
  }
  return middles;
}

Primitives primitivesOf(const PointCloud& cloud, const PrimitiveParams& params) {
  ScanSurface surface = makeScanSurface(cloud, params.sensor, params.sampling);
  return detectPrimitives(cloud, surface, params);
}

/// Planes and corners are the box's, in one exact frame; as many as `planes` and `corners`.
void expectSidesAndCorners(const Primitives& found, const Box& box, std::size_t planes,
                           std::size_t corners, double tolerance) {
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.planes.size(), planes);
  EXPECT_EQ(found.corners.size(), corners);
  expectOneExactFrame(found);
  const std::vector<Eigen::Vector3d> vertices = box.vertices();
  for (const PlanePrimitive& plane : found.planes) {
    const auto on_plane = std::count_if(vertices.begin(), vertices.end(), [&](const auto& vertex) {
      return std::abs(plane.plane.signedDistance(vertex)) < tolerance;
    });
    EXPECT_EQ(on_plane, 4) << plane.plane;
  }
  std::vector<Eigen::Vector3d> positions;
  for (const Corner& corner : found.corners) positions.push_back(corner.position);
  expectDistinct(positions, vertices, tolerance);
}

/// The whole box, and lines from corner to corner.
void expectWholeBox(const PointCloud& cloud, const PrimitiveParams& params, const Box& box,
                    double tolerance) {
  const Primitives found = primitivesOf(cloud, params);
  expectSidesAndCorners(found, box, 6, 8, tolerance);
  EXPECT_EQ(found.lines.size(), 12U);
  std::vector<Eigen::Vector3d> middles;
  for (const LineSegment& line : found.lines) {
    EXPECT_LT(distanceToNearest(line.start, box.vertices()), tolerance);
    EXPECT_LT(distanceToNearest(line.end, box.vertices()), tolerance);
    middles.push_back(0.5 * (line.start + line.end));
  }
  expectDistinct(middles, edgesOf(box), tolerance);
}

/// Three sides that meet in a corner. Their lines end where samples do, so that only their place is
/// exact. \return how many pieces the three lines are in.
std::size_t expectThreeSides(const PointCloud& cloud, const PrimitiveParams& params, const Box& box,
                             double tolerance) {
  const Primitives found = primitivesOf(cloud, params);
  expectSidesAndCorners(found, box, 3, 1, tolerance);
  std::set<std::array<int, 2>> pairs;
  for (const LineSegment& line : found.lines) {
    pairs.insert(line.planes);
    EXPECT_EQ(line.kind, LineKind::kConvex);
    for (const int plane : line.planes) {
      const Plane& side = found.planes[static_cast<std::size_t>(plane)].plane;
      EXPECT_LT(std::abs(side.signedDistance(line.start)), tolerance);
      EXPECT_LT(std::abs(side.signedDistance(line.end)), tolerance);
    }
  }
  EXPECT_EQ(pairs.size(), 3U);
  return found.lines.size();
}

/// The points of a scene as they come from a file.
PointCloud pointsOf(const test::SyntheticScene& scene, bool normals) {
  PointCloud cloud;
  cloud.points = scene.cloud.points;
  if (normals) cloud.normals = scene.cloud.normals;
  cloud.viewpoint = scene.cloud.viewpoint;
  return cloud;
}

/// What a spinning lidar sees in all directions from inside the box, as an organized cloud.
PointCloud panoramaOf(const Box& box, const Eigen::Vector3d& eye) {
  std::vector<Plane> sides;
  for (const test::Rectangle& side : test::roomSides(box.low - eye, box.high - eye)) {
    sides.push_back(side.plane());
  }
  const test::RangeAlong range = test::insideOf(sides);
  PointCloud cloud;
  cloud.rows = 240;
  cloud.cols = 720;
  cloud.columns_wrap = true;
  cloud.viewpoint = (box.cloud_from_box * eye).cast<float>();
  for (int row = 0; row < cloud.rows; ++row) {
    for (int col = 0; col < cloud.cols; ++col) {
      const Eigen::Vector3d ray =
          Eigen::AngleAxisd(-2.0 * kPi * (col + 0.3) / cloud.cols, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(kPi * ((row + 0.5) / cloud.rows - 0.5), Eigen::Vector3d::UnitY()) *
          Eigen::Vector3d::UnitX();
      cloud.points.push_back((box.cloud_from_box * (eye + range(ray) * ray)).cast<float>());
    }
  }
  return cloud;
}

Box room(const Eigen::Isometry3d& pose) { return {{-2.0, -1.5, -1.2}, {2.5, 1.8, 1.3}, pose}; }

Box cube(const Eigen::Isometry3d& pose) { return {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, pose}; }

const Eigen::Vector3d kEye(0.2, 0.1, 0.0);  ///< inside the room

PointCloud roomPoints(const Box& box, bool normals) {
  test::SyntheticOptions options;
  options.spacing = 0.03;
  return pointsOf(
      test::sampleScene(test::roomSides(box.low, box.high), kEye, box.cloud_from_box, options),
      normals);
}

PointCloud cubePoints(const Box& box, bool normals) {
  const Eigen::Vector3d viewpoint(3.0, 2.5, 2.0);
  test::SyntheticOptions options;
  options.spacing = 0.01;
  options.occlusion = false;
  return pointsOf(test::sampleScene(test::boxFromAllSides(box.low, box.high, viewpoint), viewpoint,
                                    box.cloud_from_box, options),
                  normals);
}

/// Calls f(pose) for some random poses.
template <typename F>
void atRandomPoses(std::uint64_t seed, const F& f) {
  test::Random random(seed);
  for (int k = 0; k < 3; ++k) {
    SCOPED_TRACE("pose " + std::to_string(k));
    f(random.pose(2.0));
  }
}

TEST(DetectPrimitives, RoomOfPointsWithNormalsIsExact) {
  atRandomPoses(1, [](const Eigen::Isometry3d& pose) {
    const PointCloud cloud = roomPoints(room(pose), true);
    expectWholeBox(cloud, idealSensor(), room(pose), kTolerance);
    expectWholeBox(cloud, PrimitiveParams(), room(pose), kTolerance);
  });
}

TEST(DetectPrimitives, RoomOfPointsWithoutNormalsIsExact) {
  atRandomPoses(2, [](const Eigen::Isometry3d& pose) {
    expectWholeBox(roomPoints(room(pose), false), idealSensor(), room(pose), kTolerance);
  });
}

TEST(DetectPrimitives, RoomInAPanoramaIsExact) {
  atRandomPoses(3, [](const Eigen::Isometry3d& pose) {
    expectWholeBox(panoramaOf(room(pose), kEye), idealSensor(), room(pose), kTolerance);
  });
}

TEST(DetectPrimitives, CubeOfPointsWithNormalsIsExact) {
  atRandomPoses(4, [](const Eigen::Isometry3d& pose) {
    const PointCloud cloud = cubePoints(cube(pose), true);
    expectWholeBox(cloud, idealSensor(), cube(pose), kTolerance);
    expectWholeBox(cloud, PrimitiveParams(), cube(pose), kTolerance);
  });
}

TEST(DetectPrimitives, CubeOfPointsWithoutNormalsIsExact) {
  atRandomPoses(5, [](const Eigen::Isometry3d& pose) {
    expectWholeBox(cubePoints(cube(pose), false), idealSensor(), cube(pose), kTolerance);
  });
}

TEST(DetectPrimitives, RimsDeviateByLessThanTheNoiseThatIsExpected) {
  // The defaults expect noise of 1 mm and more, so that means of points of two sides that are off
  // by as much pass for noise. They shift planes by less than noise would.
  const double tolerance = 0.25 * SensorModel().noise_constant;
  atRandomPoses(6, [&](const Eigen::Isometry3d& pose) {
    expectWholeBox(roomPoints(room(pose), false), PrimitiveParams(), room(pose), tolerance);
    expectWholeBox(panoramaOf(room(pose), kEye), PrimitiveParams(), room(pose), tolerance);
    expectWholeBox(cubePoints(cube(pose), false), PrimitiveParams(), cube(pose), tolerance);
  });
}

/// Rotations of a cube before a camera, at `range` [m], that shows three sides of it at angles of
/// less than 72° to their normals at their middles.
std::vector<Box> cubesBeforeACamera(int count) {
  test::Random random(7);
  std::vector<Box> cubes;
  while (static_cast<int>(cubes.size()) < count) {
    Box box = cube(random.pose(0.2));
    box.cloud_from_box.translation().x() += random.uniform(2.0, 3.5);
    int visible = 0;
    for (const test::Rectangle& side : test::boxSides(box.low, box.high)) {
      const Eigen::Vector3d middle = box.cloud_from_box * side.center;
      const double cosine = -box.inCloud(side).normal().dot(middle) / middle.norm();
      if (box.inCloud(side).d() > 0.0) visible += cosine > std::cos(degToRad(72.0)) ? 1 : 4;
    }
    if (visible == 3) cubes.push_back(box);
  }
  return cubes;
}

TEST(DetectPrimitives, CubeBeforeACameraShowsThreeExactSides) {
  for (const Box& box : cubesBeforeACamera(20)) {
    std::vector<Plane> sides;
    for (const auto& side : test::boxSides(box.low, box.high)) sides.push_back(box.inCloud(side));
    const PointCloud cloud = test::renderDepth({}, test::outsideOf(sides));
    expectThreeSides(cloud, idealSensor(), box, kTolerance);
    EXPECT_EQ(expectThreeSides(cloud, PrimitiveParams(), box, 0.25 * SensorModel().noise_constant),
              3U);
  }
}

}  // namespace
}  // namespace opp
