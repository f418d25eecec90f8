// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/scene.h"

#include "opp/geometry/constants.h"

#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <sstream>

namespace opp::mapping {
namespace {

constexpr const char* kPath =
    "[path]\n"
    "waypoint = 0 0 1  0 deg 0 deg\n"
    "waypoint = 1 0 1  90 deg 0 deg\n";

Scene parsed(const std::string& text) {
  std::istringstream stream(text);
  return parseScene(stream, "test.ini");
}

std::string errorOf(const std::string& text) {
  try {
    parsed(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Scene, ReadsWhatTheFileSays) {
  const Scene scene = parsed(std::string("# a comment\n"
                                         "[scene]\n"
                                         "description = a box   # not a number\n"
                                         "frames = 7\n"
                                         "[box one]\n"
                                         "at = 1 2 3\n"
                                         "size = 1 2 3\r\n"
                                         "yaw = 1.5707963267948966 rad\n"
                                         "[box two]\n"
                                         "at = 5 0 0\n"
                                         "size = 1 1 1\n") +
                             kPath);
  EXPECT_EQ(scene.description, "a box");
  EXPECT_EQ(scene.frames, 7);
  EXPECT_EQ(scene.world.faces().size(), 12U);
  ASSERT_EQ(scene.waypoints.size(), 2U);
  EXPECT_DOUBLE_EQ(scene.waypoints[1].yaw, 1.5707963267948966);
  Eigen::AlignedBox3d box;
  for (std::size_t f = 0; f < 6; ++f) {
    for (const auto& vertex : scene.world.faces()[f].outer) box.extend(vertex);
  }
  EXPECT_TRUE(box.sizes().isApprox(Eigen::Vector3d(2, 1, 3), 1e-12));  // turned by 90°
  EXPECT_TRUE(box.center().isApprox(Eigen::Vector3d(1, 2, 4.5), 1e-12));
}

TEST(Scene, ErrorsNameFileLineAndWhatIsWrong) {
  const std::string path = kPath;
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(errorOf(text).find(part), std::string::npos) << errorOf(text);
  };
  expect("size = 1 1 1\n", "test.ini:1: a key before");
  expect("[box\n", "test.ini:1: section header");
  expect("[box]\nnonsense\n", "test.ini:2: neither");
  expect("[piano]\n" + path, "test.ini:1: [piano] unknown kind");
  expect("[box]\nat = 0 0 0\nsiez = 1 1 1\nsize = 1 1 1\n" + path,
         "test.ini:3: [box] unknown key 'siez'");
  expect("[box]\nat = 0 0 0\n" + path, "test.ini:1: [box] 'size' is missing");
  expect("[box]\nat = 0 0\nsize = 1 1 1\n" + path, "test.ini:2: [box] 'at' needs 3 numbers, has 2");
  expect("[box]\nat = 0 0 x\nsize = 1 1 1\n" + path, "'x' is not a number");
  expect("[box]\nat = 0 0 inf\nsize = 1 1 1\n" + path, "'inf' is not a number");
  expect("[box]\nat = 0 0 0\nat = 0 0 0\nsize = 1 1 1\n" + path,
         "test.ini:3: [box] 'at' is given twice");
  expect("[box]\nat = 0 0 0\nsize = 1 1 1\nyaw = 30\n" + path, "needs 'deg' or 'rad'");
  expect("[box]\nat = 0 0 0\nsize = 1 1 -1\n" + path, "test.ini:1: [box] size of a box must be");
  expect("[scene]\nframes = 0\n" + path, "'frames' must be");
  expect("[face]\nvertex = 0 0 0\nvertex = 1 0 0\n" + path, "fewer than 3");
  expect("[room]\nheight = 2\nwalls = some\n" + path, "'walls' must be all or none");
  expect(path, "no solid in the scene");
  expect("[box]\nat = 0 0 0\nsize = 1 1 1\n", "at least two waypoint");
  expect(
      "[box]\nat = 0 0 0\nsize = 1 1 1\n[path]\nwaypoint = 0 0 0 0 0\nwaypoint = 1 0 0 0 deg 0 "
      "deg\n",
      "the angle 0 needs 'deg' or 'rad'");
  expect("", "no solid in the scene");
}

TEST(Scene, BuiltInScenesHaveAPlaceToBeAndAWayThroughIt) {
  const auto names = builtInScenes();
  EXPECT_EQ(names.size(), 8U);
  for (const auto name : names) {
    SCOPED_TRACE(name);
    const Scene scene = loadScene(std::string(name));
    EXPECT_EQ(scene.name, name);
    EXPECT_FALSE(scene.description.empty());
    EXPECT_GE(scene.world.faces().size(), 6U);
    EXPECT_FALSE(builtInSceneText(name).empty());
  }
  EXPECT_THROW(builtInSceneText("moon"), std::invalid_argument);
}

TEST(Scene, TiltedWallsStandAtTheAnglesThatTheDescriptionStates) {
  const Scene scene = loadScene("tilted");
  const auto angleWithFloor = [&](std::size_t face) {
    return radToDeg(kPi -
                    angleBetween(scene.world.faces()[0].plane, scene.world.faces()[face].plane));
  };
  EXPECT_NEAR(180.0 - angleWithFloor(4), 94.0, 1e-9);  // leans inward: its normal looks down
  EXPECT_NEAR(180.0 - angleWithFloor(5), 100.0, 1e-9);
}

TEST(Scene, FilesAreReadLikeBuiltInScenesAndMissingOnesNamed) {
  const test::TempFolder folder;
  test::writeFile(folder / "mine.ini", builtInSceneText("cube"));
  const Scene scene = loadScene((folder / "mine.ini").string());
  EXPECT_EQ(scene.name, "mine");
  EXPECT_EQ(scene.world.faces().size(), 6U);
  try {
    loadScene((folder / "none.ini").string());
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("none.ini"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("apartment"), std::string::npos);
  }
}

}  // namespace
}  // namespace opp::mapping
