// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/world.h"

#include "opp/mapping/simulation/furniture.h"
#include "opp/mapping/simulation/solids.h"

#include "support/random.h"

#include <gtest/gtest.h>

#include <limits>

namespace opp::mapping {
namespace {

Eigen::Vector3d areaVector(const std::vector<Eigen::Vector3d>& ring) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    sum += 0.5 * (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]);
  }
  return sum;
}

/// By Gauss' theorem: a third of the flux of x through all faces.
double enclosedVolume(const World& world) {
  double volume = 0.0;
  for (const Face& face : world.faces()) {
    double area = face.plane.normal().dot(areaVector(face.outer));
    for (const auto& hole : face.holes) area -= areaVector(hole).norm();
    volume -= area * face.plane.d() / 3.0;
  }
  return volume;
}

TEST(World, FrontOfAFaceIsWhereItsOutlineRunsCounterClockwise) {
  World world;
  world.addFace({{0, 0, 2}, {1, 0, 2}, {0, 1, 2}});
  EXPECT_TRUE(world.sidePlane(0).normal().isApprox(Eigen::Vector3d::UnitZ(), 1e-15));
  EXPECT_DOUBLE_EQ(world.sidePlane(0).d(), -2.0);
  EXPECT_TRUE(world.sidePlane(1).normal().isApprox(-Eigen::Vector3d::UnitZ(), 1e-15));
  EXPECT_DOUBLE_EQ(world.sidePlane(1).d(), 2.0);
}

TEST(World, RefusesFacesThatAreNoFlatPolygons) {
  World world;
  EXPECT_THROW(world.addFace({}), std::invalid_argument);
  EXPECT_THROW(world.addFace({{0, 0, 0}, {1, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(world.addFace({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(world.addFace({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.01}}),
               std::invalid_argument);
  EXPECT_THROW(world.addFace({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{{0, 0, 0}, {1, 0, 0}}}),
               std::invalid_argument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(world.addFace({{0, 0, 0}, {1, nan, 0}, {1, 1, 0}}), std::invalid_argument);
  EXPECT_TRUE(world.faces().empty());
}

TEST(Solids, BoxEnclosesItsVolumeWhereverItStands) {
  test::Random random(11);
  for (int trial = 0; trial < 60; ++trial) {
    World world;
    const Eigen::Vector3d size(random.uniform(0.01, 3), random.uniform(0.01, 3),
                               random.uniform(0.01, 3));
    addBox(world, random.pose(5.0), size);
    EXPECT_EQ(world.faces().size(), 6U);
    // Rounding: a volume of up to 27 m³ out of terms of up to 10 m × 9 m².
    EXPECT_NEAR(enclosedVolume(world), size.prod(), 1e-12);
  }
}

TEST(Solids, RoomIsSeenFromInside) {
  World world;
  addRoom(world, {{0, 0}, {4, 0}, {4, 3}, {0, 3}}, 0.0, 2.5);
  EXPECT_EQ(world.faces().size(), 6U);
  EXPECT_NEAR(enclosedVolume(world), -30.0, 1e-12);
  for (const Face& face : world.faces()) {
    EXPECT_GT(face.plane.signedDistance({1.0, 1.0, 1.0}), 0.0);
  }
}

TEST(Solids, WallWithOpeningsLacksOnlyTheirVolume) {
  World world;
  Wall wall;
  wall.start = {1, 1};
  wall.end = {1, 6};
  wall.thickness = 0.2;
  wall.height = 2.5;
  wall.openings = {{0.5, 0.9, 0.0, 2.0, false}, {2.0, 1.5, 0.9, 1.2, false}};
  addWall(world, wall);
  // Its foot, which stands on the floor and is never seen, is the one face that is missing; at
  // z = 0 it adds nothing to the integral.
  EXPECT_NEAR(enclosedVolume(world), 0.2 * (5.0 * 2.5 - 0.9 * 2.0 - 1.5 * 1.2), 1e-12);
}

TEST(Solids, CylinderFacetsAreNoPlanesOfTheTruthButItsEndsAre) {
  World world;
  addCylinder(world, Eigen::Isometry3d::Identity(), 0.5, 1.0, 12);
  int curved = 0;
  for (const Face& face : world.faces()) curved += face.curved ? 1 : 0;
  EXPECT_EQ(curved, 12);
  EXPECT_EQ(world.faces().size(), 14U);
  EXPECT_NEAR(enclosedVolume(world), 0.5 * 12 * 0.25 * std::sin(2 * 3.14159265358979323846 / 12),
              1e-12);
}

TEST(Solids, RefuseSizesThatAreNotPositiveAndOpeningsOutsideOfTheWall) {
  World world;
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  EXPECT_THROW(addBox(world, here, {1, 0, 1}), std::invalid_argument);
  EXPECT_THROW(addBox(world, here, {1, -1, 1}), std::invalid_argument);
  EXPECT_THROW(addCylinder(world, here, 0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(addCylinder(world, here, 1.0, 1.0, 2), std::invalid_argument);
  EXPECT_THROW(addRoom(world, {{0, 0}, {1, 0}}, 0, 2), std::invalid_argument);
  EXPECT_THROW(addRoom(world, {{0, 0}, {0, 3}, {4, 3}, {4, 0}}, 0, 2), std::invalid_argument);
  Wall wall;
  EXPECT_THROW(addWall(world, wall), std::invalid_argument);  // no length
  wall.end = {3, 0};
  wall.openings = {{2.5, 0.9, 0.0, 2.0, false}};
  EXPECT_THROW(addWall(world, wall), std::invalid_argument);
  wall.openings = {{1.0, 0.5, 0.0, 2.0, false}, {0.2, 0.5, 0.0, 2.0, false}};
  EXPECT_THROW(addWall(world, wall), std::invalid_argument);
}

TEST(Furniture, EachKindFillsItsSizeAndStaysInside) {
  for (const auto* kind : {"table", "chair", "cabinet", "shelf", "bed", "sofa"}) {
    SCOPED_TRACE(kind);
    EXPECT_TRUE(isFurniture(kind));
    World world;
    const Eigen::Vector3d size(0.9, 1.6, 1.0);
    addFurniture(world, kind, Eigen::Isometry3d::Identity(), size);
    Eigen::AlignedBox3d box;
    for (const Face& face : world.faces()) {
      for (const auto& vertex : face.outer) box.extend(vertex);
    }
    EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d(-0.45, -0.8, 0.0), 1e-12));
    EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d(0.45, 0.8, 1.0), 1e-12));
  }
  World world;
  EXPECT_FALSE(isFurniture("piano"));
  EXPECT_THROW(addFurniture(world, "piano", Eigen::Isometry3d::Identity(), {1, 1, 1}),
               std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
