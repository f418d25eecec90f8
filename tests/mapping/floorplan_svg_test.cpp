// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/floorplan_svg.h"

#include "opp/mapping/core/move_planar_map.h"
#include "opp/mapping/planar/level_frame.h"

#include "support/random.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

PlanarMapPlane plane(int id, PlaneKind kind, const std::vector<Eigen::Vector3d>& outer,
                     const std::vector<std::vector<Eigen::Vector3d>>& holes = {}) {
  PlanarMapPlane result;
  result.id = id;
  result.kind = kind;
  result.plane = Plane::fromPointNormal(outer[0], (outer[1] - outer[0]).cross(outer[2] - outer[1]));
  result.polygons = {{outer, holes}};
  result.centroid = outer[0];
  result.area = (outer[1] - outer[0]).cross(outer[2] - outer[1]).norm();
  return result;
}

/// A floor of 4 × 3 m and the wall at y = 3 with a door from x = 1 to 2; body walks along x.
PlanarMap room() {
  PlanarMap map;
  map.planes.push_back(plane(0, PlaneKind::kFloor, {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}}));
  map.planes.push_back(plane(1, PlaneKind::kWall, {{4, 3, 0}, {0, 3, 0}, {0, 3, 2.5}, {4, 3, 2.5}},
                             {{{2, 3, 0.1}, {2, 3, 2}, {1, 3, 2}, {1, 3, 0.1}}}));
  return map;
}

TEST(FloorplanSvg, CutsTheWallAtItsDoor) {
  const std::string svg = floorplanSvg(room(), {}, Eigen::Vector3d::UnitZ());
  // Margin 0.5 m, 100 units a metre, y downward: (0, 3) is at (50, 50), (1, 3) at (150, 50).
  EXPECT_NE(svg.find("class=\"wall\" d=\"M450 50L250 50M150 50L50 50\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("class=\"floor\" fill-rule=\"evenodd\" d=\"M50 350L450 350L450 50L50 50Z\""),
            std::string::npos)
      << svg;
  EXPECT_NE(svg.find(">1 m</text>"), std::string::npos) << "a quarter of 5 m is 1.25 m";
}

TEST(FloorplanSvg, IsTheSameFromWhereverTheMapIsSeen) {
  const Trajectory way{{0.0, Eigen::Isometry3d(Eigen::Translation3d(1.0, 1.0, 1.5))},
                       {1.0, Eigen::Isometry3d(Eigen::Translation3d(3.0, 1.0, 1.5))}};
  const std::string expected = floorplanSvg(room(), way, Eigen::Vector3d::UnitZ());
  EXPECT_NE(expected.find("class=\"way\" d=\"M150 250L350 250\""), std::string::npos);
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    // Tilted by less than an eighth turn, so that the plan keeps its side up.
    Eigen::Isometry3d tilt = random.motion(0.5, 0.0);
    tilt.linear() =
        Eigen::AngleAxisd(random.uniform(-0.5, 0.5), Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(random.uniform(-0.5, 0.5), Eigen::Vector3d::UnitY()).toRotationMatrix();
    Trajectory tilted = way;
    for (StampedPose& pose : tilted) pose.map_from_body = tilt * pose.map_from_body;
    EXPECT_EQ(floorplanSvg(movedPlanarMap(tilt, room()), tilted,
                           tilt.linear() * Eigen::Vector3d::UnitZ()),
              expected);
  }
}

TEST(FloorplanSvg, EmptyMapIsAPage) {
  const test::TempFolder folder;
  writeFloorplan(folder / "plan.svg", PlanarMap(), {}, Eigen::Vector3d::UnitZ());
  const std::string svg = test::readFile(folder / "plan.svg");
  EXPECT_EQ(svg.rfind("<svg ", 0), 0U);
  EXPECT_NE(svg.find("cm</text>"), std::string::npos);
  EXPECT_THROW(writeFloorplan("/nowhere/plan.svg", PlanarMap(), {}, Eigen::Vector3d::UnitZ()),
               std::runtime_error);
}

TEST(LevelFromMap, PutsUpAlongZAndWallsAlongTheAxes) {
  test::Random random(2);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Isometry3d turn(random.rotation());
    const PlanarMap turned = movedPlanarMap(turn, room());
    const Eigen::Vector3d up = turn.linear().col(2);
    const Eigen::Isometry3d level = levelFromMap(turned, up);
    EXPECT_LT((level.linear() * up - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
    const Eigen::Vector3d wall = level.linear() * turned.planes[1].plane.normal();
    EXPECT_NEAR(std::max(std::abs(wall.x()), std::abs(wall.y())), 1.0, 1e-9);
  }
  EXPECT_TRUE(
      levelFromMap(PlanarMap(), Eigen::Vector3d::UnitZ()).isApprox(Eigen::Isometry3d::Identity()));
}

}  // namespace
}  // namespace opp::mapping
