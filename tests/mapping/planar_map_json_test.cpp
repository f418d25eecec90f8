// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/planar_map_json.h"

#include "support/planar_map_schema.h"
#include "support/random.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <limits>

namespace opp::mapping {
namespace {

PlanarPolygon squareOn(const Plane& plane, test::Random& random) {
  const Eigen::Matrix<double, 3, 2> axes = tangentBasis(plane.normal());
  const Eigen::Vector3d center = plane.project(random.vector(2.0));
  const auto ring = [&](double size) {
    std::vector<Eigen::Vector3d> vertices;
    for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      vertices.push_back(center + size * (u * axes.col(0) + v * axes.col(1)));
    }
    return vertices;
  };
  PlanarPolygon polygon{ring(1.0), {ring(0.5)}};
  std::reverse(polygon.holes[0].begin(), polygon.holes[0].end());
  return polygon;
}

PlanarMap randomMap(test::Random& random) {
  PlanarMap map;
  for (int id = 0; id < 3; ++id) {
    PlanarMapPlane plane;
    plane.id = id;
    plane.plane = Plane::fromPointNormal(random.vector(3.0), random.unitVector());
    plane.centroid = random.vector(3.0);
    plane.area = random.uniform(0.1, 10.0);
    plane.points = random.integer(1, 1000000);
    plane.rms = random.uniform(0.0, 0.01);
    plane.family = id == 0 ? 0 : -1;
    plane.kind = id == 0 ? PlaneKind::kFloor : PlaneKind::kWall;
    plane.polygons = {squareOn(plane.plane, random)};
    plane.orthogonal_to = id == 0 ? std::vector<int>{1, 2} : std::vector<int>{0};
    plane.covariance = random.rotation();
    plane.observations = {1.5e9 + random.uniform(0.0, 1.0), 1.5e9 + 2.0};
    map.planes.push_back(plane);
  }
  map.families.push_back({0, map.planes[0].plane.normal(), {0}});
  map.lines.push_back({0, {0, 1}, random.vector(1.0), random.vector(1.0), LineKind::kConcave});
  PlanarMapCorner corner;
  corner.planes = {0, 1, 2};
  corner.position = random.vector(2.0);
  corner.orientation = Eigen::Quaterniond(random.rotation());
  corner.kind = CornerKind::kSaddle;
  map.corners.push_back(corner);
  return map;
}

std::string errorOf(const std::string& text) {
  try {
    parsePlanarMap(text, "map.json");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(PlanarMapJson, ReadsBackTheSameBytes) {
  test::Random random(1);
  for (int k = 0; k < 50; ++k) {
    const PlanarMap map = randomMap(random);
    const std::string text = formatPlanarMap(map);
    const PlanarMap back = parsePlanarMap(text, "map.json");
    // Planes are normalized again, which may move the last digit: their text may differ by that.
    ASSERT_EQ(back.planes.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT((back.planes[i].plane.coefficients() - map.planes[i].plane.coefficients()).norm(),
                1e-15);
      EXPECT_EQ(back.planes[i].polygons[0].outer, map.planes[i].polygons[0].outer);
      EXPECT_EQ(back.planes[i].polygons[0].holes, map.planes[i].polygons[0].holes);
      EXPECT_EQ(back.planes[i].covariance, map.planes[i].covariance);
      EXPECT_EQ(back.planes[i].observations, map.planes[i].observations);
      EXPECT_EQ(back.planes[i].kind, map.planes[i].kind);
      EXPECT_EQ(back.planes[i].family, map.planes[i].family);
    }
    EXPECT_EQ(back.corners[0].position, map.corners[0].position);
    EXPECT_EQ(back.corners[0].orientation.coeffs(), map.corners[0].orientation.coeffs());
    EXPECT_EQ(back.lines[0].start, map.lines[0].start);
    EXPECT_EQ(back.families[0].planes, map.families[0].planes);
    PlanarMap same_planes = back;
    for (std::size_t i = 0; i < 3; ++i) same_planes.planes[i].plane = map.planes[i].plane;
    EXPECT_EQ(formatPlanarMap(same_planes), text);
  }
}

TEST(PlanarMapJson, EmptyMapIsAMap) {
  const PlanarMap back = parsePlanarMap(formatPlanarMap(PlanarMap()), "map.json");
  EXPECT_EQ(back.frame, "map");
  EXPECT_TRUE(back.planes.empty() && back.lines.empty() && back.corners.empty());
}

/// A map with one more plane, line and corner that were barely seen.
PlanarMap mapWithBarelySeen(test::Random& random) {
  PlanarMap map = randomMap(random);
  map.barely_seen.planes = {map.planes[2]};
  map.barely_seen.planes[0].id = 3;
  map.barely_seen.planes[0].orthogonal_to.clear();
  map.barely_seen.lines = {{1, {1, 3}, random.vector(1.0), random.vector(1.0)}};
  map.barely_seen.corners = {map.corners[0]};
  map.barely_seen.corners[0].planes = {0, 1, 3};
  return map;
}

TEST(PlanarMapJson, WhatWasBarelySeenIsKeptApart) {
  test::Random random(7);
  const PlanarMap map = mapWithBarelySeen(random);
  const std::string text = formatPlanarMap(map);
  const PlanarMap back = parsePlanarMap(text, "map.json");
  EXPECT_EQ(back.planes.size(), 3U);
  ASSERT_EQ(back.barely_seen.planes.size(), 1U);
  EXPECT_EQ(back.barely_seen.planes[0].id, 3);
  EXPECT_EQ(back.barely_seen.lines.at(0).end, map.barely_seen.lines[0].end);
  EXPECT_EQ(back.barely_seen.corners.at(0).planes, (std::array<int, 3>{0, 1, 3}));
  EXPECT_EQ(formatPlanarMap(randomMap(random)).find("barely_seen"), std::string::npos);
  EXPECT_NE(errorOf(replaced(text, "\"planes\":[1,3]", "\"planes\":[1,4]"))
                .find("barely_seen.lines: refers to the missing id 4"),
            std::string::npos);
  EXPECT_NE(errorOf(replaced(text, "\"id\":3", "\"id\":2")).find("id 2 occurs twice"),
            std::string::npos);
}

TEST(PlanarMapJson, DetectionAddsItsTimes) {
  const DetectionSummary summary{{{"normals", 1.5}, {"total", 3.0}}, 42};
  const std::string text = formatPlanarMap(PlanarMap(), &summary);
  EXPECT_NE(text.find("\"timings_ms\": {\"normals\":1.5,\"total\":3.0}, \"points\": 42"),
            std::string::npos)
      << text;
}

TEST(PlanarMapJson, RejectsNumbersThatAreNotFinite) {
  test::Random random(2);
  PlanarMap map = randomMap(random);
  map.corners[0].position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(formatPlanarMap(map), std::invalid_argument);
}

TEST(PlanarMapJson, ErrorsNameTheElement) {
  test::Random random(3);
  const std::string text = formatPlanarMap(randomMap(random));
  EXPECT_EQ(errorOf(text), "");
  EXPECT_NE(errorOf(replaced(text, "\"rms\"", "\"rmx\"")).find("planes[0]: key \"rms\" is missing"),
            std::string::npos);
  EXPECT_NE(errorOf(replaced(text, "\"wall\"", "\"hall\"")).find("planes[1].kind: \"hall\""),
            std::string::npos);
  EXPECT_NE(errorOf(replaced(text, "\"planes\":[0,1]", "\"planes\":[0,7]")).find("missing id 7"),
            std::string::npos);
  EXPECT_NE(errorOf(replaced(text, "\"id\":1", "\"id\":0")).find("id 0 occurs twice"),
            std::string::npos);
  EXPECT_NE(errorOf(replaced(text, "\"normal\":[", "\"normal\":[1,1,")).find("planes[0].normal"),
            std::string::npos);
  EXPECT_NE(errorOf(replaced(text, "\"version\": 1", "\"version\": 2")).find("version"),
            std::string::npos);
  EXPECT_NE(errorOf("[]").find("map.json: key \"format\" is missing"), std::string::npos);
  EXPECT_THROW(readPlanarMap("/nowhere/map.json"), std::runtime_error);
}

TEST(PlanarMapJson, BrokenTextNeverPasses) {
  test::Random random(4);
  const std::string text = formatPlanarMap(randomMap(random));
  for (int k = 0; k < 200; ++k) {
    EXPECT_NE(errorOf(text.substr(0, static_cast<std::size_t>(
                                         random.integer(0, static_cast<int>(text.size()) - 3)))),
              "");
  }
}

TEST(PlanarMapJson, FollowsTheSchema) {
  test::Random random(5);
  const test::TempFolder folder;
  writePlanarMap(folder / "map.json", mapWithBarelySeen(random));
  const DetectionSummary summary{{{"total", 3.0}}, 42};
  writePlanarMap(folder / "empty.json", PlanarMap(), &summary);
  const auto result = test::validatePlanarMaps({folder / "map.json", folder / "empty.json"});
  EXPECT_EQ(result.exit_code, 0) << result;
}

TEST(PlanarMapJson, TheSchemaTellsWhatIsWrong) {
  const test::TempFolder folder;
  test::Random random(6);
  std::string text = formatPlanarMap(randomMap(random));
  text.replace(text.find("\"version\": 1"), 12, "\"version\": 2");
  test::writeFile(folder / "map.json", text);
  const auto result = test::validatePlanarMaps({folder / "map.json"});
  EXPECT_EQ(result.exit_code, 1) << result;
  EXPECT_NE(result.err.find("map.json: $.version"), std::string::npos) << result;
}

}  // namespace
}  // namespace opp::mapping
