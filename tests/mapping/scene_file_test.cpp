// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/export/scene_file.h"

#include "opp/mapping/io/planar_map_json.h"
#include "opp/mapping/io/tum_trajectory.h"

#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <limits>
#include <map>

namespace opp::mapping {
namespace {

const PlanarMap& demoMap() {
  static const PlanarMap map = readPlanarMap(OPP_SOURCE_FOLDER "/rawlogs/demo.gt.json");
  return map;
}

const Trajectory& demoWay() {
  static const Trajectory way =
      readTumTrajectory(std::filesystem::path(OPP_SOURCE_FOLDER "/rawlogs/demo.gt.tum"));
  return way;
}

TEST(WriteScene, ViewerFindsEachLayer) {
  const test::TempFolder folder;
  writeScene(folder / "map.3Dscene", demoMap(), demoWay());
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile((folder / "map.3Dscene").string()));
  for (const char* name : {"planes", "outlines", "lines", "corners", "trajectory"}) {
    EXPECT_TRUE(scene.getByName(name)) << name;
  }
  const auto corners =
      std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(scene.getByName("corners"));
  EXPECT_EQ(corners->size(), demoMap().corners.size());
  const auto way =
      std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(scene.getByName("trajectory"));
  EXPECT_EQ(way->size(), demoWay().size() - 1);
}

TEST(WriteScene, EmptyMapAndBadFolder) {
  const test::TempFolder folder;
  writeScene(folder / "map.3Dscene", PlanarMap(), {});
  mrpt::opengl::COpenGLScene scene;
  EXPECT_TRUE(scene.loadFromFile((folder / "map.3Dscene").string()));
  EXPECT_THROW(writeScene("/nowhere/map.3Dscene", PlanarMap(), {}), std::runtime_error);
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"map.3Dscene"});
}

TEST(RenderScene, ShowsTheMapInTheMiddleOfTheImage) {
  const test::TempFolder folder;
  for (const SceneView view : {SceneView::kPerspective, SceneView::kTop}) {
    RenderOptions options;
    options.view = view;
    options.width = 320;
    options.height = 240;
    try {
      renderScene(folder / "map.png", demoMap(), demoWay(), Eigen::Vector3d::UnitZ(), options);
    } catch (const std::exception& error) {
      GTEST_SKIP() << "NOT TESTED: no off-screen OpenGL here: " << error.what();
    }
    mrpt::img::CImage image;
    ASSERT_TRUE(image.loadFromFile((folder / "map.png").string()));
    ASSERT_EQ(image.getWidth(), 320U);
    ASSERT_EQ(image.getHeight(), 240U);
    int drawn = 0, on_border = 0;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        if (image.at<uint8_t>(static_cast<unsigned>(x), static_cast<unsigned>(y), 0) == 255)
          continue;
        ++drawn;
        if (x == 0 || y == 0 || x == 319 || y == 239) ++on_border;
      }
    }
    EXPECT_GT(drawn, 320 * 240 / 5);
    EXPECT_EQ(on_border, 0) << "nothing is cut off";
  }
}

TEST(RenderScene, RejectsBadSizes) {
  RenderOptions options;
  options.width = 0;
  EXPECT_THROW(renderScene("/tmp/never.png", PlanarMap(), {}, Eigen::Vector3d::UnitZ(), options),
               std::invalid_argument);
}

}  // namespace
}  // namespace opp::mapping
