// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/run_command.h"

#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace opp::test {
namespace {

TEST(RunCommand, GivesExitCodeAndBothOutputs) {
  const CommandResult result = runCommand({"sh", "-c", "echo result; echo log >&2; exit 3"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.out, "result\n");
  EXPECT_EQ(result.err, "log\n");
}

TEST(RunCommand, PassesArgumentsAsTheyAre) {
  const CommandResult result = runCommand({"printf", "%s|", "two words", "$HOME", "\"", ""});
  EXPECT_EQ(result.out, "two words|$HOME|\"||");
}

TEST(RunCommand, TellsASignalAsAShellDoes) {
  EXPECT_EQ(runCommand({"sh", "-c", "kill -9 $$"}).exit_code, 128 + 9);
}

TEST(RunCommand, RunsInTheGivenFolder) {
  const TempFolder folder;
  EXPECT_EQ(runCommand({"pwd", "-P"}, folder.path()).out,
            std::filesystem::canonical(folder.path()).string() + "\n");
}

TEST(RunCommand, ThrowsWhereThereIsNoSuchProgram) {
  EXPECT_THROW(runCommand({"/no/such/program"}), std::runtime_error);
}

}  // namespace
}  // namespace opp::test
