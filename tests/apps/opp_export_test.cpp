// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace opp {
namespace {

const std::string kMap = OPP_SOURCE_FOLDER "/rawlogs/demo.gt.json";

TEST(OppExport, WritesEachFormatByItsExtension) {
  const test::TempFolder folder;
  const std::vector<std::pair<std::string, std::string>> beginnings{
      {"map.svg", "<svg "}, {"map.ply", "ply\n"}, {"map.obj", "# Planar map"}, {"map.glb", "glTF"}};
  for (const auto& [name, beginning] : beginnings) {
    const auto result = test::runApp("opp-export", {"-i", kMap, "-o", (folder / name).string()});
    EXPECT_EQ(result.exit_code, 0) << result;
    EXPECT_EQ(test::readFile(folder / name).substr(0, beginning.size()), beginning);
  }
  EXPECT_EQ(folder.contents().size(), 4U);
}

TEST(OppExport, RefusesWhatItCannotDo) {
  const test::TempFolder folder;
  const auto unknown = test::runApp("opp-export", {"-i", kMap, "-o", (folder / "a.stl").string()});
  EXPECT_EQ(unknown.exit_code, 2) << unknown;
  EXPECT_NE(unknown.err.find("extension"), std::string::npos);
  const auto missing =
      test::runApp("opp-export", {"-i", "none.json", "-o", (folder / "a.ply").string()});
  EXPECT_EQ(missing.exit_code, 1) << missing;
  EXPECT_NE(missing.err.find("none.json"), std::string::npos);
  EXPECT_TRUE(folder.contents().empty());
}

}  // namespace
}  // namespace opp
