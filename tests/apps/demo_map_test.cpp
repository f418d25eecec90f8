// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/tum_trajectory.h"

#include "support/planar_map_schema.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <memory>

namespace opp::test {
namespace {

const std::string kRawlogs = OPP_SOURCE_FOLDER "/rawlogs/";

/// Not a matcher, which would print the whole page.
bool has(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

/// What the text has between the two words; empty if it lacks them.
std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const std::size_t found = text.find(before);
  if (found == std::string::npos) return "";
  const std::size_t begin = found + before.size();
  return text.substr(begin, text.find(after, begin) - begin);
}

std::string decodedBase64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    if (letter == '=') break;
    bits = bits << 6U | static_cast<std::uint32_t>(digits.find(letter));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 255U);
  }
  return bytes;
}

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
       {"trajectory.tum", "map.bt", "map.ot", "planar_map.json", "planar_map.ply", "planar_map.obj",
        "planar_map.glb", "floorplan.svg", "scene.3Dscene", "map.simplemap", "report.html",
        "run.json", "effective.ini"}) {
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

TEST_F(DemoMap, ReportHoldsTheMeshAndTheFloorPlanByteForByte) {
  const std::string page = readFile(file("report.html"));
  const std::string mesh = between(page, "<script type=\"text/plain\" id=\"glb\">", "</script>");
  EXPECT_TRUE(decodedBase64(mesh) == readFile(file("planar_map.glb")));
  const std::string plan = between(page, "src=\"data:image/svg+xml;base64,", "\"");
  EXPECT_TRUE(decodedBase64(plan) == readFile(file("floorplan.svg")));
  EXPECT_LT(page.size(), 2000000U);
}

TEST_F(DemoMap, ReportHasTheFiguresOfRunJson) {
  const std::string page = readFile(file("report.html"));
  const auto run = nlohmann::json::parse(readFile(file("run.json")));
  ASSERT_FALSE(run["seconds"].empty());
  for (const auto& [stage, seconds] : run["seconds"].items()) {
    EXPECT_TRUE(has(page, "<th>" + stage + "</th><td><data value=\"" + seconds.dump() + "\">"));
  }
  for (const auto& [name, count] : run["counts"].items()) {
    EXPECT_TRUE(has(page, "<th>" + name + "</th><td>" + count.dump() + "</td>"));
  }
  const auto& session = run["sessions"].at(0);
  EXPECT_TRUE(has(page, "sha256 " + session["input"]["sha256"].get<std::string>()));
  for (const auto& value : {session["path_length_m"], run["peak_memory_mb"]}) {
    EXPECT_TRUE(has(page, "<data value=\"" + value.dump() + "\">"));
  }
}

}  // namespace
}  // namespace opp::test
