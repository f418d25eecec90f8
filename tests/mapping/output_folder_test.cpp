// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/output_folder.h"

#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace opp::mapping {
namespace {

using Names = std::vector<std::string>;

void finishRun(const std::filesystem::path& folder, bool force, const Names& files) {
  OutputFolder output(folder, force);
  for (const std::string& name : files) test::writeFile(output.path() / name, "by " + files[0]);
  output.commit();
}

std::string messageOf(const std::filesystem::path& folder, bool force) {
  try {
    const OutputFolder output(folder, force);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no std::runtime_error";
}

TEST(OutputFolder, HoldsAllFilesAfterCommitAndNothingElse) {
  const test::TempFolder temp;
  finishRun(temp / "a/out/", false, {"trajectory.tum", "run.json"});
  EXPECT_EQ(temp.contents(), (Names{"a", "a/out", "a/out/run.json", "a/out/trajectory.tum"}));
}

TEST(OutputFolder, WithoutCommitNothingIsLeft) {
  const test::TempFolder temp;
  {
    const OutputFolder output(temp / "a/b/out", false);
    test::writeFile(output.path() / "trajectory.tum", "half");
  }
  EXPECT_TRUE(temp.contents().empty());
}

TEST(OutputFolder, RefusesAFinishedRunUnlessForced) {
  const test::TempFolder temp;
  finishRun(temp / "out", false, {"run.json"});
  EXPECT_THAT(messageOf(temp / "out", false), testing::HasSubstr("--force"));
  EXPECT_EQ(temp.contents(), (Names{"out", "out/run.json"}));
  EXPECT_EQ(messageOf(temp / "out", true), "no std::runtime_error");
}

TEST(OutputFolder, RefusesToOverwriteResultsWithoutRunJsonToo) {
  const test::TempFolder temp;
  test::writeFile(temp / "trajectory.tum", "the user's");
  EXPECT_THAT(messageOf(temp.path(), false), testing::HasSubstr("trajectory.tum"));
  EXPECT_EQ(test::readFile(temp / "trajectory.tum"), "the user's");
}

TEST(OutputFolder, ForcedRunThatFailsLosesNothing) {
  const test::TempFolder temp;
  finishRun(temp / "out", false, {"first", "map.bt", "run.json"});
  {
    const OutputFolder output(temp / "out", true);
    test::writeFile(output.path() / "map.bt", "half");
  }
  EXPECT_EQ(test::readFile(temp / "out/map.bt"), "by first");
  EXPECT_EQ(temp.contents(), (Names{"out", "out/first", "out/map.bt", "out/run.json"}));
}

TEST(OutputFolder, ForcedRunReplacesResultsAndKeepsOtherFiles) {
  const test::TempFolder temp;
  finishRun(temp / "out", false, {"first", "map.bt", "trajectory.tum", "run.json"});
  finishRun(temp / "out", true, {"trajectory.tum", "run.json"});
  EXPECT_EQ(temp.contents(), (Names{"out", "out/first", "out/run.json", "out/trajectory.tum"}));
  EXPECT_EQ(test::readFile(temp / "out/trajectory.tum"), "by trajectory.tum");
}

TEST(OutputFolder, ClearsWhatAKilledRunLeft) {
  const test::TempFolder temp;
  std::filesystem::create_directories(temp / "out/.unfinished");
  test::writeFile(temp / "out/.unfinished/map.bt", "half");
  finishRun(temp / "out", false, {"run.json"});
  EXPECT_EQ(temp.contents(), (Names{"out", "out/run.json"}));
}

TEST(OutputFolder, KeepsACheckpointOnly) {
  const test::TempFolder temp;
  {
    const OutputFolder output(temp / "out", false);
    test::writeFile(output.checkpoint(), "half-way");
    test::writeFile(output.path() / "trajectory.tum", "half");
  }
  const Names kept = {"out", "out/.unfinished", "out/.unfinished/checkpoint"};
  EXPECT_EQ(temp.contents(), kept);
  test::writeFile(temp / "out/.unfinished/map.bt", "half");
  {
    const OutputFolder output(temp / "out", false, true);
    EXPECT_EQ(test::readFile(output.checkpoint()), "half-way");
    EXPECT_FALSE(std::filesystem::exists(output.path() / "map.bt"));
  }
  EXPECT_EQ(temp.contents(), kept) << "nothing was done with it";
  { const OutputFolder output(temp / "out", false); }
  EXPECT_EQ(temp.contents(), Names{"out"}) << "a run that does not resume clears it";
}

TEST(OutputFolder, FinishedRunHasNoCheckpoint) {
  const test::TempFolder temp;
  {
    OutputFolder output(temp / "out", false, true);
    test::writeFile(output.checkpoint(), "all");
    test::writeFile(output.path() / "run.json", "all");
    output.commit();
  }
  EXPECT_EQ(temp.contents(), (Names{"out", "out/run.json"}));
}

TEST(OutputFolder, RunThatWasKilledAsItsFilesMovedIsResumed) {
  const test::TempFolder temp;
  std::filesystem::create_directories(temp / "out/.unfinished");
  test::writeFile(temp / "out/.unfinished/checkpoint", "all");
  test::writeFile(temp / "out/map.bt", "moved");
  { const OutputFolder output(temp / "out", false, true); }
  EXPECT_THAT(messageOf(temp / "out", false), testing::HasSubstr("map.bt"));
  test::writeFile(temp / "out/run.json", "a run");
  EXPECT_THROW(OutputFolder(temp / "out", false, true), std::runtime_error) << "it is finished";
}

TEST(OutputFolder, TwoRunsCannotWriteAtOnce) {
  const test::TempFolder temp;
  OutputFolder first(temp / "out", false);
  test::writeFile(first.path() / "run.json", "first");
  EXPECT_THAT(messageOf(temp / "out", true), testing::HasSubstr("another run"));
  first.commit();
  EXPECT_EQ(test::readFile(temp / "out/run.json"), "first");
}

TEST(OutputFolder, RefusesAFileInPlaceOfTheFolder) {
  const test::TempFolder temp;
  test::writeFile(temp / "file", "x");
  EXPECT_THAT(messageOf(temp / "file", true), testing::HasSubstr("not a folder"));
  EXPECT_THAT(messageOf(temp / "file/out", true), testing::HasSubstr("not a folder"));
}

TEST(OutputFolder, CommitNeedsRunJson) {
  const test::TempFolder temp;
  OutputFolder output(temp / "out", false);
  EXPECT_THROW(output.commit(), std::logic_error);
}

}  // namespace
}  // namespace opp::mapping
