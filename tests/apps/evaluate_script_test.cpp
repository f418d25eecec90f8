// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace opp {
namespace {

const std::string kScript = OPP_SOURCE_FOLDER "/tests/benchmark/evaluate";

/// Rows of the table that the script makes with these arguments.
nlohmann::json rowsOf(const test::TempFolder& output, std::vector<std::string> arguments,
                      int expected_exit_code) {
  arguments.insert(arguments.begin(), {"python3", kScript, "--output", output.path().string()});
  const test::CommandResult result = test::runCommand(arguments);
  EXPECT_EQ(result.exit_code, expected_exit_code) << result;
  EXPECT_EQ(output.contents(), (std::vector<std::string>{"evaluation.json", "evaluation.md"}));
  return nlohmann::json::parse(test::readFile(output / "evaluation.json")).at("rows");
}

const std::string kBuild =
    std::filesystem::path(test::appPath("opp-simulate")).parent_path().string();

TEST(EvaluateScript, SimulatesAndSaysWhatWasSeen) {
  const test::TempFolder output;
  const auto rows = rowsOf(output,
                           {"--build", kBuild, "--frames", "2", "--scenes", "cube", "--sensors",
                            "ideal", "--only", "simulate cube"},
                           0);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].at("frames"), 2);
  EXPECT_GT(rows[0].at("planes"), 0);
  EXPECT_NE(test::readFile(output / "evaluation.md").find("| cube ideal | 2 |"), std::string::npos);
}

TEST(EvaluateScript, MapsAndDetectsAndKeepsTheOrderOfRowsWithSeveralJobs) {
  const test::TempFolder output;
  const auto rows = rowsOf(
      output,
      {"--build", kBuild,     "--rate",          "10",     "--frames",  "3",      "--detect-frames",
       "2",       "--scenes", "blank",           "room",   "--sensors", "kinect", "--jobs",
       "2",       "--only",   "map blank robot", "--only", "map room",  "--only", "detect room"},
      0);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].at("table"), "map");
  EXPECT_EQ(rows[0].at("name"), "room kinect");
  EXPECT_EQ(rows[0].at("frames"), 3);
  EXPECT_EQ(rows[0].at("used"), 3);
  EXPECT_LT(rows[0].at("ate_rmse_m"), 0.05);
  EXPECT_GT(rows[0].at("planes_recall"), 0.0);
  EXPECT_EQ(rows[1].at("table"), "detect");
  EXPECT_EQ(rows[1].at("frames"), 2);
  EXPECT_GT(rows[1].at("planes_precision"), 0.0);
  EXPECT_GT(rows[1].at("median_ms"), 0.0);
  EXPECT_EQ(rows[2].at("name"), "blank robot");
}

TEST(EvaluateScript, SimulatesRandomFlats) {
  const test::TempFolder output;
  const auto rows = rowsOf(
      output, {"--build", kBuild, "--frames", "1", "--flats", "2:3", "--only", "simulate flat"}, 0);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("name"), "flat 2");
  EXPECT_EQ(rows[1].at("name"), "flat 3");
  for (const auto& row : rows) EXPECT_GE(row.at("planes"), 1) << row;
}

TEST(EvaluateScript, ProgramsThatAreMissingMakeRowsThatSaySo) {
  const test::TempFolder output;
  const test::TempFolder empty;
  const auto rows = rowsOf(output,
                           {"--build", empty.path().string(), "--data", empty.path().string(),
                            "--scenes", "cube", "--sensors", "ideal"},
                           1);
  EXPECT_GT(rows.size(), 10u);
  for (const auto& row : rows) {
    EXPECT_NE(row.at("failed").get<std::string>().find("is not built"), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace opp
