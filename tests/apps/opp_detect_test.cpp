// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/cloud_file.h"
#include "opp/mapping/io/planar_map_json.h"

#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

namespace opp::test {
namespace {

using testing::HasSubstr;

/// The corner of a room at (2, 1, -1), seen from the origin: floor and two walls of 1 m x 1 m.
std::string roomCorner() {
  constexpr int kSteps = 40;
  std::ostringstream os;
  for (int i = 0; i < kSteps; ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const double u = (i + 0.5) / kSteps, v = (k + 0.5) / kSteps;
      os << 2.0 << ' ' << 1.0 - u << ' ' << v - 1.0 << '\n'
         << 2.0 - u << ' ' << 1.0 << ' ' << v - 1.0 << '\n'
         << 2.0 - u << ' ' << 1.0 - v << ' ' << -1.0 << '\n';
    }
  }
  return os.str();
}

TEST(OppDetect, FindsPlanesLinesAndCornerOfARoom) {
  const TempFolder folder;
  writeFile(folder / "room.xyz", roomCorner());
  const CommandResult result = runApp(
      "opp-detect",
      {"-i", (folder / "room.xyz").string(), "-o", (folder / "room.json").string(), "--labels",
       (folder / "room.ply").string(), "--scene", (folder / "room.3Dscene").string(), "--set",
       "sensor.noise_constant=1e-6 m", "--set", "sensor.noise_quadratic=0 1/m"});
  ASSERT_EQ(result.exit_code, 0) << result;
  EXPECT_EQ(result.out, "");
  const mapping::PlanarMap map = mapping::readPlanarMap(folder / "room.json");
  EXPECT_EQ(map.planes.size(), 3U);
  EXPECT_EQ(map.lines.size(), 3U);
  ASSERT_EQ(map.corners.size(), 1U);
  // No noise, and none expected: what is left is the rounding of single precision.
  EXPECT_LT((map.corners[0].position - Eigen::Vector3d(2, 1, -1)).norm(), 1e-5);
  const std::string json = readFile(folder / "room.json");
  for (const char* key : {"\"frame\": \"sensor\"", "\"points\": 4800", "\"timings_ms\"",
                          "\"normals\"", "\"sampling\"", "\"voting\"", "\"clustering\"",
                          "\"refinement\"", "\"lines\"", "\"corners\"", "\"total\""}) {
    EXPECT_THAT(json, HasSubstr(key));
  }
  const mapping::LabeledCloud labeled = mapping::readLabeledCloudFile(folder / "room.ply");
  ASSERT_EQ(labeled.labels.size(), 4800U);
  EXPECT_EQ(std::set<int>(labeled.labels.begin(), labeled.labels.end()), (std::set<int>{0, 1, 2}));
}

TEST(OppDetect, CloudWithoutPointsGivesAMapWithoutPlanes) {
  const TempFolder folder;
  writeFile(folder / "none.xyz", "# nothing\n");
  const CommandResult result = runApp(
      "opp-detect", {"-i", (folder / "none.xyz").string(), "-o", (folder / "none.json").string()});
  ASSERT_EQ(result.exit_code, 0) << result;
  EXPECT_TRUE(mapping::readPlanarMap(folder / "none.json").planes.empty());
}

TEST(OppDetect, BadInputIsAnErrorAndWritesNothing) {
  const TempFolder folder;
  writeFile(folder / "bad.ply", std::string("\x7f\x01random\xff", 9));
  writeFile(folder / "empty.rawlog", "");
  for (const char* name : {"missing.ply", "bad.ply", "empty.rawlog"}) {
    const CommandResult result = runApp(
        "opp-detect", {"-i", (folder / name).string(), "-o", (folder / "out.json").string()});
    EXPECT_EQ(result.exit_code, 1) << result;
    EXPECT_THAT(result.err, HasSubstr(name));
  }
  EXPECT_EQ(folder.contents(), (std::vector<std::string>{"bad.ply", "empty.rawlog"}));
}

TEST(OppDetect, WrongUsageIsToldApart) {
  const TempFolder folder;
  const std::string room = (folder / "room.xyz").string();
  const std::string out = (folder / "out.json").string();
  writeFile(room, "1 2 3\n");
  EXPECT_EQ(runApp("opp-detect", {"-i", room}).exit_code, 2);
  EXPECT_EQ(runApp("opp-detect", {"-i", room, "-o", out, "--index", "1"}).exit_code, 2);
  EXPECT_EQ(runApp("opp-detect", {"-i", room, "-o", out, "--set", "sampling.gate=99"}).exit_code,
            2);
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"room.xyz"});
}

}  // namespace
}  // namespace opp::test
