// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/gray_png.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace opp {
namespace {

using test::CommandResult;
using test::runApp;

class OppImport : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(set_ / "depth");
    test::writeGrayPng(set_ / "depth/a.png", 4, 3, std::vector<std::uint16_t>(12, 5000));
    test::writeFile(set_ / "depth.txt", "1.5 depth/a.png\n");
    test::writeFile(set_ / "groundtruth.txt", "1.5 0 0 1 -0.5 0.5 -0.5 0.5\n");
  }
  CommandResult import(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "--format", "tum", "-i", set_.path().string(), "-o", (output_ / "x.rawlog").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runApp("opp-import", arguments);
  }
  test::TempFolder set_;
  test::TempFolder output_;
};

TEST_F(OppImport, WritesARawlogAndTheTruthBesideIt) {
  const CommandResult result = import({"--intrinsics", "5,5,1.5,1", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result;
  EXPECT_EQ(output_.contents(), (std::vector<std::string>{"x.gt.tum", "x.rawlog"}));
  EXPECT_EQ(test::readFile(output_ / "x.gt.tum"),
            "# timestamp tx ty tz qx qy qz qw\n1.500000 0 0 1 0 0 0 1\n");
  EXPECT_EQ(result.err, "");
}

TEST_F(OppImport, SaysThatASetHasNoPoses) {
  std::filesystem::remove(set_ / "groundtruth.txt");
  const CommandResult result = import({"--intrinsics", "5,5,1.5,1"});
  EXPECT_EQ(result.exit_code, 0) << result;
  EXPECT_NE(result.err.find("no true poses"), std::string::npos) << result;
  EXPECT_EQ(output_.contents(), std::vector<std::string>{"x.rawlog"});
}

TEST_F(OppImport, SaysWhatIsWrongAndLeavesNothing) {
  EXPECT_EQ(import({}).exit_code, 1);  // 640 × 480 intrinsics for 4 × 3 pixels
  std::filesystem::remove(set_ / "depth/a.png");
  const CommandResult result = import({"--intrinsics", "5,5,1.5,1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("depth/a.png: missing"), std::string::npos) << result;
  EXPECT_TRUE(output_.contents().empty());
}

TEST_F(OppImport, WrongUsageEndsWithTwo) {
  EXPECT_EQ(runApp("opp-import", {}).exit_code, 2);
  EXPECT_EQ(import({"--intrinsics", "kinect"}).exit_code, 2);
  EXPECT_EQ(import({"--depth-unit", "mm"}).exit_code, 2);
  EXPECT_EQ(runApp("opp-import", {"--format", "bag", "-i", "x", "-o", "y"}).exit_code, 2);
  EXPECT_TRUE(output_.contents().empty());
}

}  // namespace
}  // namespace opp
