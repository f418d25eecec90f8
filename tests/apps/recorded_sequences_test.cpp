// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/run_command.h"
#include "support/shared_data.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace opp {
namespace {

struct Sequence {
  const char* name;
  const char* truth;
  const char* config;
  const char* every;
  double max_error;  ///< [m] root mean square: what registration to a model reaches, with some room
};

class RecordedSequence : public testing::TestWithParam<Sequence> {};

TEST_P(RecordedSequence, AllFramesThatAreUsedAreLocalized) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const test::TempFolder folder;
  const auto file = [&](const char* extension) {
    return test::sharedData(std::string(GetParam().name) + extension).string();
  };
  const test::CommandResult map =
      test::runApp("opp-map", {"-i", file(".rawlog"), "-o", (folder / "map").string(), "-c",
                               std::string(OPP_SOURCE_FOLDER "/config/") + GetParam().config,
                               "--every", GetParam().every, "--no-octomap", "--quiet"});
  ASSERT_EQ(map.exit_code, 0) << map;
  const auto report = nlohmann::json::parse(test::readFile(folder / "map/run.json"));
  EXPECT_EQ(report.at("sessions").at(0).at("frames_lost"), 0);
  const test::CommandResult eval =
      test::runApp("opp-eval", {"--gt", file(GetParam().truth), "--est",
                                (folder / "map/trajectory.tum").string(), "--json"});
  ASSERT_EQ(eval.exit_code, 0) << eval;
  const auto error = nlohmann::json::parse(eval.out).at("trajectory");
  EXPECT_LT(error.at("ate").at("translation_m").at("rmse"), GetParam().max_error);
}

INSTANTIATE_TEST_SUITE_P(
    All, RecordedSequence,
    testing::Values(Sequence{"tum_fr3_structure_notexture_far", ".gt.tum", "rgbd.ini", "10", 0.015},
                    Sequence{"icl_of_kt3", ".gt.tum", "rgbd.ini", "10", 0.015},
                    Sequence{"redwood_livingroom1", ".ref.tum", "rgbd.ini", "10", 0.015},
                    Sequence{"simulated_lidar_hall", ".gt.tum", "lidar.ini", "1", 0.005}),
    [](const auto& sequence) { return std::string(sequence.param.name); });

// The hall is symmetric, and its steps of 1.8 m with turns of 40° are more than motion expects:
// what is lost there may stay lost, but must not be found the wrong way round.
class HallInStrides : public testing::TestWithParam<const char*> {};

TEST_P(HallInStrides, NoPoseIsTheWrongWayRound) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const test::TempFolder folder;
  const std::string hall = test::sharedData("simulated_lidar_hall").string();
  const test::CommandResult map =
      test::runApp("opp-map", {"-i", hall + ".rawlog", "-o", (folder / "map").string(), "-c",
                               OPP_SOURCE_FOLDER "/config/lidar.ini", "--every", GetParam(),
                               "--no-octomap", "--quiet"});
  ASSERT_EQ(map.exit_code, 0) << map;
  const std::string report = test::readFile(folder / "map/run.json");
  if (nlohmann::json::parse(report).at("sessions").at(0).at("frames_used") < 3) return;
  const test::CommandResult eval = test::runApp(
      "opp-eval",
      {"--gt", hall + ".gt.tum", "--est", (folder / "map/trajectory.tum").string(), "--json"});
  ASSERT_EQ(eval.exit_code, 0) << eval;
  const auto error = nlohmann::json::parse(eval.out).at("trajectory");
  EXPECT_LT(error.at("ate").at("translation_m").at("max"), 0.02);
}

INSTANTIATE_TEST_SUITE_P(All, HallInStrides, testing::Values("2", "4", "5", "8"),
                         [](const auto& step) { return std::string("Every") + step.param; });

}  // namespace
}  // namespace opp
