// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/ground_truth.h"

#include "opp/mapping/simulation/solids.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opp::mapping {
namespace {

PlanarMap truthOf(const std::string& scene, SimulatedSensor sensor, int frames,
                  int decimation = 2) {
  SimulationOptions options;
  options.sensor = sensor;
  options.frames = frames;
  options.decimation = decimation;
  const Simulator simulator(loadScene(scene), options);
  GroundTruth truth(simulator.scene().world, GroundTruthParams::forSensor(sensor));
  for (int i = 0; i < simulator.frames(); ++i)
    truth.add(simulator.frame(i), options.body_from_sensor);
  return truth.map();
}

double polygonArea(const PlanarMapPlane& plane) {
  const auto area = [&](const std::vector<Eigen::Vector3d>& ring) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      sum += 0.5 * (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]);
    }
    return plane.plane.normal().dot(sum);  // positive: counter-clockwise seen from the front
  };
  double result = 0.0;
  for (const PlanarPolygon& polygon : plane.polygons) {
    EXPECT_GT(area(polygon.outer), 0.0);
    result += area(polygon.outer);
    for (const auto& hole : polygon.holes) {
      EXPECT_LT(area(hole), 0.0);
      result += area(hole);
    }
  }
  return result;
}

TEST(GroundTruth, CubeFromAllSidesHasSixPlanesTwelveLinesAndEightCorners) {
  const PlanarMap map = truthOf("cube", SimulatedSensor::kIdeal, 24);
  EXPECT_EQ(map.planes.size(), 6U);
  EXPECT_EQ(map.families.size(), 3U);
  ASSERT_EQ(map.lines.size(), 12U);
  ASSERT_EQ(map.corners.size(), 8U);
  for (const PlanarMapPlane& plane : map.planes) {
    EXPECT_NEAR(plane.area, 1.0, 1e-9);
    EXPECT_EQ(plane.orthogonal_to.size(), 4U);
    EXPECT_NEAR(plane.centroid.norm(), 0.5, 1e-9);
  }
  for (const PlanarMapLine& line : map.lines) {
    EXPECT_EQ(line.kind, LineKind::kConvex);
    EXPECT_NEAR((line.end - line.start).norm(), 1.0, 1e-5);  // faces touch within 1 µm
  }
  for (const PlanarMapCorner& corner : map.corners) {
    EXPECT_EQ(corner.kind, CornerKind::kConvex);
    EXPECT_TRUE(corner.position.cwiseAbs().isApprox(Eigen::Vector3d::Constant(0.5), 1e-12));
  }
}

TEST(GroundTruth, HoldsOnlyWhatWasSeen) {
  World world;
  addBox(world, Eigen::Isometry3d::Identity(), {1, 1, 1});
  const PinholeCamera camera;
  Eigen::Isometry3d map_from_sensor = Eigen::Isometry3d::Identity();
  map_from_sensor.translation() << -2.0, 0.0, 0.5;  // looks at one face, head on
  SimulatedFrame frame;
  frame.map_from_body = map_from_sensor;
  frame.timestamp = 5.0;
  frame.data = renderIdeal(RayTracer(world), map_from_sensor, camera, 2e-4);
  GroundTruth truth(world, {});
  EXPECT_TRUE(truth.map().planes.empty());
  truth.add(frame, Eigen::Isometry3d::Identity());
  const PlanarMap map = truth.map();
  ASSERT_EQ(map.planes.size(), 1U);
  EXPECT_TRUE(map.lines.empty());
  EXPECT_TRUE(map.corners.empty());
  EXPECT_EQ(map.planes[0].observations, std::vector<double>{5.0});
  // (575 px · 1 m / 1.5 m)² of image.
  EXPECT_NEAR(static_cast<double>(map.planes[0].points), 146944.0, 800.0);
  EXPECT_TRUE(map.planes[0].plane.normal().isApprox(-Eigen::Vector3d::UnitX(), 1e-15));
}

TEST(GroundTruth, WhatTooFewPixelsSawIsKeptApart) {
  // A floor and a wall that meet at x = 2, the wall behind a screen but for what the slot below
  // shows.
  World world;
  world.addFace({{0, -1, 0}, {2, -1, 0}, {2, 1, 0}, {0, 1, 0}});
  world.addFace({{2, -1, 0}, {2, -1, 2}, {2, 1, 2}, {2, 1, 0}});
  world.addFace({{1.9, -1, 0.1}, {1.9, -1, 3}, {1.9, 1, 3}, {1.9, 1, 0.1}});
  SimulatedFrame frame;
  frame.map_from_body.translation() << 0.0, 0.0, 1.0;
  frame.map_from_body.linear() =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()).toRotationMatrix();
  frame.data =
      renderIdeal(RayTracer(world), frame.map_from_body, PinholeCamera().decimated(4), 2e-4);
  const auto seen = [&](int min_pixels) {
    GroundTruthParams params;
    params.min_pixels = min_pixels;
    GroundTruth truth(world, params);
    truth.add(frame, Eigen::Isometry3d::Identity());
    return truth.map();
  };
  const PlanarMap all = seen(1);
  ASSERT_EQ(all.planes.size(), 3U);
  EXPECT_TRUE(all.barely_seen.planes.empty());
  ASSERT_EQ(all.lines.size(), 1U);  // the screen does not touch the floor
  const long wall_pixels = all.planes[1].points;
  const PlanarMap most = seen(static_cast<int>(wall_pixels) + 1);
  EXPECT_EQ(most.planes.size(), 2U);
  EXPECT_TRUE(most.lines.empty());
  ASSERT_EQ(most.barely_seen.planes.size(), 1U);
  EXPECT_EQ(most.barely_seen.planes[0].id, 2);
  EXPECT_EQ(most.barely_seen.planes[0].points, wall_pixels);
  ASSERT_EQ(most.barely_seen.lines.size(), 1U);
  const PlanarMapLine& seam = most.barely_seen.lines[0];
  EXPECT_EQ(seam.planes, (std::array<int, 2>{0, 2}));
  // All of it, seen or not, and near_gap beyond either end.
  EXPECT_NEAR((seam.end - seam.start).norm(), 2.1, 1e-9);
}

TEST(GroundTruth, FacesThatNearlyTouchMayBeTakenForTouching) {
  for (const double gap : {0.0, 0.02, 0.08}) {
    World world;
    world.addFace({{0, -1, 0}, {2.0 - gap, -1, 0}, {2.0 - gap, 1, 0}, {0, 1, 0}});
    world.addFace({{2, -1, 0}, {2, -1, 2}, {2, 1, 2}, {2, 1, 0}});
    SimulatedFrame frame;
    frame.map_from_body.translation().z() = 1.0;
    frame.map_from_body.linear() =
        Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()).toRotationMatrix();
    frame.data = renderIdeal(RayTracer(world), frame.map_from_body, PinholeCamera(), 2e-4);
    GroundTruth truth(world, {});
    truth.add(frame, Eigen::Isometry3d::Identity());
    const PlanarMap map = truth.map();
    EXPECT_EQ(map.lines.size(), gap == 0.0 ? 1U : 0U) << gap;
    EXPECT_EQ(map.barely_seen.lines.size(), gap == 0.02 ? 1U : 0U) << gap;
  }
}

TEST(GroundTruth, LinesAndTheRestOfTheirSeamAreDisjoint) {
  for (const auto name : builtInScenes()) {
    const PlanarMap map = truthOf(std::string(name), SimulatedSensor::kKinect, 3, 4);
    for (const PlanarMapLine& rest : map.barely_seen.lines) {
      const Eigen::Vector3d direction = (rest.end - rest.start).normalized();
      const double length = (rest.end - rest.start).norm();
      for (const PlanarMapLine& line : map.lines) {
        if (line.planes != rest.planes) continue;
        const double a = direction.dot(line.start - rest.start);
        const double b = direction.dot(line.end - rest.start);
        EXPECT_TRUE(std::max(a, b) < 1e-9 || std::min(a, b) > length - 1e-9) << name;
      }
    }
    for (const PlanarMapPlane& plane : map.barely_seen.planes) EXPECT_LT(plane.points, 300);
  }
}

TEST(GroundTruth, TwoSidesOfAWallAreTwoPlanes) {
  World world;
  world.addFace({{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}});
  GroundTruth truth(world, {});
  for (const double x : {-2.0, 2.0}) {
    SimulatedFrame frame;
    frame.map_from_body.translation().x() = x;
    if (x > 0.0)
      frame.map_from_body.linear() =
          Eigen::AngleAxisd(3.14159265358979, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    frame.data =
        renderIdeal(RayTracer(world), frame.map_from_body, PinholeCamera().decimated(4), 2e-4);
    truth.add(frame, Eigen::Isometry3d::Identity());
  }
  const PlanarMap map = truth.map();
  ASSERT_EQ(map.planes.size(), 2U);
  EXPECT_TRUE(map.planes[0].plane.normal().isApprox(-map.planes[1].plane.normal(), 1e-12));
  EXPECT_EQ(map.families.size(), 1U);
}

TEST(GroundTruth, CoplanarFacesAreOnePlaneUnlessFarApart) {
  for (const double gap : {0.3, 0.7}) {
    World world;
    for (const double y : {0.0, 0.5 + gap}) {
      world.addFace({{2, y, -0.3}, {2, y, 0.3}, {2, y + 0.5, 0.3}, {2, y + 0.5, -0.3}});
    }
    SimulatedFrame frame;
    frame.map_from_body.translation().y() = 0.5 + 0.5 * gap;
    frame.data = renderIdeal(RayTracer(world), frame.map_from_body, PinholeCamera(), 2e-4);
    GroundTruth truth(world, {});
    truth.add(frame, Eigen::Isometry3d::Identity());
    EXPECT_EQ(truth.map().planes.size(), gap < 0.5 ? 1U : 2U);
  }
}

TEST(GroundTruth, RoomEdgesAreConcave) {
  World world;
  addRoom(world, {{0, 0}, {3, 0}, {3, 3}, {0, 3}}, 0.0, 2.5);
  SimulatedFrame frame;
  frame.map_from_body.translation() << 1.0, 1.0, 1.5;
  frame.map_from_body.linear() = (Eigen::AngleAxisd(0.785, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()))
                                     .toRotationMatrix();
  frame.data = renderIdeal(RayTracer(world), frame.map_from_body, PinholeCamera(), 2e-4);
  GroundTruth truth(world, {});
  truth.add(frame, Eigen::Isometry3d::Identity());
  const PlanarMap map = truth.map();
  ASSERT_EQ(map.planes.size(), 3U);
  ASSERT_EQ(map.lines.size(), 3U);
  for (const PlanarMapLine& line : map.lines) EXPECT_EQ(line.kind, LineKind::kConcave);
  ASSERT_EQ(map.corners.size(), 1U);
  EXPECT_EQ(map.corners[0].kind, CornerKind::kConcave);
  EXPECT_TRUE(map.corners[0].position.isApprox(Eigen::Vector3d(3, 3, 0), 1e-12));
}

TEST(GroundTruth, IsExactInEachSceneAndForEachKindOfSensor) {
  for (const auto name : builtInScenes()) {
    for (const auto sensor : {SimulatedSensor::kKinect, SimulatedSensor::kLidar16}) {
      SCOPED_TRACE(std::string(name) + (sensor == SimulatedSensor::kKinect ? " kinect" : " lidar"));
      const PlanarMap map = truthOf(std::string(name), sensor, 5, 4);
      const auto plane = [&](int id) -> const Plane& {
        return map.planes[static_cast<std::size_t>(id)].plane;
      };
      EXPECT_GE(map.planes.size(), 3U);
      EXPECT_GE(map.lines.size(), 2U);
      for (const PlanarMapPlane& entry : map.planes) {
        EXPECT_GE(entry.points, 300);
        EXPECT_NEAR(polygonArea(entry), entry.area, 1e-9 * (1.0 + entry.area));
        EXPECT_GT(entry.area, 0.0);
        for (const PlanarPolygon& polygon : entry.polygons) {
          for (const auto& vertex : polygon.outer) {
            EXPECT_NEAR(entry.plane.signedDistance(vertex), 0.0, 1e-12);
          }
        }
        for (const int id : entry.orthogonal_to) {
          EXPECT_NEAR(entry.plane.normal().dot(plane(id).normal()), 0.0, 1e-12);
        }
      }
      for (const PlanarMapLine& line : map.lines) {
        for (const int id : line.planes) {
          EXPECT_NEAR(plane(id).signedDistance(line.start), 0.0, 1e-12);
          EXPECT_NEAR(plane(id).signedDistance(line.end), 0.0, 1e-12);
        }
      }
      for (const PlanarMapCorner& corner : map.corners) {
        const Eigen::Matrix3d axes = corner.orientation.toRotationMatrix();
        for (int k = 0; k < 3; ++k) {
          const Plane& p = plane(corner.planes[static_cast<std::size_t>(k)]);
          EXPECT_NEAR(p.signedDistance(corner.position), 0.0, 1e-12);
          EXPECT_NEAR(std::abs(p.normal().dot(axes.col(k))), 1.0, 1e-12);
        }
      }
    }
  }
}

TEST(GroundTruth, HexagonalHallHasNoLineBetweenItsWalls) {
  const PlanarMap map = truthOf("hall", SimulatedSensor::kKinect, 30);
  for (const PlanarMapLine& line : map.lines) {
    const auto& a = map.planes[static_cast<std::size_t>(line.planes[0])];
    const auto& b = map.planes[static_cast<std::size_t>(line.planes[1])];
    EXPECT_FALSE(a.kind == PlaneKind::kWall && b.kind == PlaneKind::kWall && a.area > 3.0 &&
                 b.area > 3.0);
  }
}

TEST(GroundTruth, RefusesParametersOutOfRange) {
  GroundTruthParams params;
  params.cell = 0.0;
  const World world;
  EXPECT_THROW(GroundTruth(world, params), std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
