// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/tum_trajectory.h"

#include "support/planar_map_schema.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

namespace opp::test {
namespace {

const std::string kRawlogs = OPP_SOURCE_FOLDER "/rawlogs/";

/// One run of opp-map on the demo, shared by the tests.
class DemoMap : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    result_ = runApp("opp-map", {"-i", kRawlogs + "demo.rawlog", "-o", file(""), "--threads", "2"});
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override { ASSERT_EQ(result_.exit_code, 0) << result_; }

  static std::string file(const std::string& name) {
    return (*folder_ / "out").string() + "/" + name;
  }

  static std::unique_ptr<TempFolder> folder_;
  static CommandResult result_;
};
std::unique_ptr<TempFolder> DemoMap::folder_;
CommandResult DemoMap::result_;

TEST_F(DemoMap, HasTheFilesOfTheContract) {
  const std::vector<std::string> names = folder_->contents();
  for (const char* name :
       {"trajectory.tum", "map.bt", "map.ot", "planar_map.json", "run.json", "effective.ini"}) {
    EXPECT_THAT(names, testing::Contains(std::string("out/") + name));
  }
  EXPECT_THAT(names, testing::Not(testing::Contains(testing::HasSubstr("/.")))) << "leftovers";
  EXPECT_EQ(result_.out, "") << "progress belongs on stderr";
}

TEST_F(DemoMap, EveryFrameIsLocalized) {
  EXPECT_EQ(mapping::readTumTrajectory(file("trajectory.tum")).size(),
            mapping::readTumTrajectory(kRawlogs + "demo.gt.tum").size());
}

TEST_F(DemoMap, RepeatedFromItsEffectiveIniOnOneThreadGivesTheSameBytes) {
  const std::string again = (*folder_ / "again").string();
  const CommandResult result =
      runApp("opp-map", {"-i", kRawlogs + "demo.rawlog", "-o", again, "-c", file("effective.ini"),
                         "--threads", "1", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result;
  EXPECT_EQ(result.err, "") << "--quiet";
  for (const char* name :
       {"trajectory.tum", "planar_map.json", "map.ot", "map.bt", "effective.ini"}) {
    EXPECT_TRUE(readFile(file(name)) == readFile(again + "/" + name)) << name << " differs";
  }
}

TEST_F(DemoMap, OctomapsOwnToolsReadItsMaps) {
  const std::string copy = (*folder_ / "copy.bt").string();
  EXPECT_EQ(runCommand({"convert_octree", file("map.ot"), copy}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(copy));
  const std::string scene = (*folder_ / "map.vrml").string();
  EXPECT_EQ(runCommand({"bt2vrml", file("map.bt"), scene}).exit_code, 0);
}

TEST_F(DemoMap, PlanarMapFollowsItsSchema) {
  const CommandResult result = validatePlanarMaps({file("planar_map.json")});
  EXPECT_EQ(result.exit_code, 0) << result;
}

}  // namespace
}  // namespace opp::test
