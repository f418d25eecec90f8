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

TEST(EvaluateScript, SimulatesAndSaysWhatWasSeen) {
  const std::string build =
      std::filesystem::path(test::appPath("opp-simulate")).parent_path().string();
  const test::TempFolder output;
  const auto rows = rowsOf(output,
                           {"--build", build, "--frames", "2", "--scenes", "cube", "--sensors",
                            "ideal", "--only", "simulate cube"},
                           0);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].at("frames"), 2);
  EXPECT_GT(rows[0].at("planes"), 0);
  EXPECT_NE(test::readFile(output / "evaluation.md").find("| cube ideal | 2 |"), std::string::npos);
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
