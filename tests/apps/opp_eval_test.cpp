// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/trajectory.h"
#include "opp/mapping/io/tum_trajectory.h"

#include "support/random.h"
#include "support/run_command.h"
#include "support/shared_data.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace opp::mapping {
namespace {

using test::CommandResult;
using test::runApp;

Trajectory randomWalk(std::uint64_t seed) {
  test::Random random(seed);
  Trajectory path;
  Eigen::Isometry3d pose = random.pose(2.0);
  for (int k = 0; k < 60; ++k) {
    path.push_back({100.0 + k / 30.0, pose});
    pose = pose * random.motion(0.05, 0.1);
  }
  return path;
}

class OppEval : public testing::Test {
 protected:
  std::string write(const std::string& name, const Trajectory& trajectory) {
    writeTumTrajectory(folder_ / name, trajectory);
    return (folder_ / name).string();
  }
  std::string writeText(const std::string& name, const std::string& text) {
    test::writeFile(folder_ / name, text);
    return (folder_ / name).string();
  }
  test::TempFolder folder_;
};

TEST_F(OppEval, TruthAgainstItselfHasNoError) {
  const std::string gt = write("gt.tum", randomWalk(1));
  const CommandResult result = runApp("opp-eval", {"--gt", gt, "--est", gt, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result;
  const auto json = nlohmann::json::parse(result.out).at("trajectory");
  EXPECT_EQ(json.at("matched"), 60);
  EXPECT_EQ(json.at("coverage"), 1.0);
  EXPECT_LT(json.at("ate").at("translation_m").at("rmse"), 1e-12);
  EXPECT_LT(json.at("ate").at("rotation_rad").at("max"), 1e-7);
  EXPECT_LT(json.at("rpe_per_frame").at("translation_m").at("max"), 1e-12);
  EXPECT_LT(json.at("rpe_per_metre").at("translation_m_per_m").at("max"), 1e-12);
}

TEST_F(OppEval, TablePrintsEveryMeasureOnStdout) {
  const std::string gt = write("gt.tum", randomWalk(2));
  const CommandResult result = runApp("opp-eval", {"--gt", gt, "--est", gt});
  ASSERT_EQ(result.exit_code, 0) << result;
  for (const char* row :
       {"ATE translation [m]", "ATE rotation [deg]", "RPE per frame, rotation [rad]",
        "RPE per metre, translation [m/m]", "coverage"}) {
    EXPECT_NE(result.out.find(row), std::string::npos) << row;
  }
  EXPECT_EQ(result.err, "");
}

TEST_F(OppEval, NothingToCompareEndsWithOne) {
  const std::string gt = write("gt.tum", randomWalk(3));
  Trajectory later = randomWalk(3);
  for (auto& pose : later) pose.timestamp += 1000.0;
  for (const std::string& est : {write("later.tum", later), write("empty.tum", {})}) {
    const CommandResult result = runApp("opp-eval", {"--gt", gt, "--est", est});
    EXPECT_EQ(result.exit_code, 1) << result;
    EXPECT_NE(result.err.find("nothing to compare"), std::string::npos) << result;
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(OppEval, BadFilesEndWithOneAndNameTheFile) {
  const std::string gt = write("gt.tum", randomWalk(4));
  for (const std::string& est :
       {(folder_ / "missing.tum").string(), folder_.path().string(),
        writeText("nan.tum", "1 nan 0 0 0 0 0 1\n"), writeText("bytes.tum", "\x01\xff\x00 \n8")}) {
    const CommandResult result = runApp("opp-eval", {"--gt", gt, "--est", est});
    EXPECT_EQ(result.exit_code, 1) << result;
    EXPECT_NE(result.err.find(est), std::string::npos) << result;
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(OppEval, WrongUsageEndsWithTwo) {
  const std::string gt = write("gt.tum", randomWalk(5));
  EXPECT_EQ(runApp("opp-eval", {}).exit_code, 2);
  EXPECT_EQ(runApp("opp-eval", {"--gt", gt}).exit_code, 2);
  EXPECT_EQ(runApp("opp-eval", {"--gt", gt, "--est", gt, "--no-such-flag"}).exit_code, 2);
  EXPECT_EQ(runApp("opp-eval", {"--gt", gt, "--est", gt, "--rpe-distance", "far"}).exit_code, 2);
  EXPECT_EQ(runApp("opp-eval", {"--help"}).exit_code, 0);
  EXPECT_EQ(runApp("opp-eval", {"--version"}).exit_code, 0);
}

}  // namespace
}  // namespace opp::mapping
