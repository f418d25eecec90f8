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

using Json = nlohmann::json;

/// Maps every so many-th scan of a sequence into `folder / "map"`; the report of its session.
Json mapSequence(const std::string& name, const std::string& config, const char* every,
                 const test::TempFolder& folder) {
  const test::CommandResult map = test::runApp(
      "opp-map",
      {"-i", test::sharedData(name + ".rawlog").string(), "-o", (folder / "map").string(), "-c",
       OPP_SOURCE_FOLDER "/config/" + config, "--every", every, "--no-octomap", "--quiet"});
  EXPECT_EQ(map.exit_code, 0) << map;
  return Json::parse(test::readFile(folder / "map/run.json")).at("sessions").at(0);
}

/// Error of the trajectory in `folder / "map"` [m].
Json errorOf(const std::string& truth, const test::TempFolder& folder) {
  const test::CommandResult eval =
      test::runApp("opp-eval", {"--gt", test::sharedData(truth).string(), "--est",
                                (folder / "map/trajectory.tum").string(), "--json"});
  EXPECT_EQ(eval.exit_code, 0) << eval;
  return Json::parse(eval.out).at("trajectory").at("ate").at("translation_m");
}

class RecordedSequence : public testing::TestWithParam<Sequence> {};

TEST_P(RecordedSequence, AllFramesThatAreUsedAreLocalized) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const test::TempFolder folder;
  const Sequence& sequence = GetParam();
  const Json session = mapSequence(sequence.name, sequence.config, sequence.every, folder);
  EXPECT_EQ(session.at("frames_lost"), 0);
  EXPECT_LT(errorOf(std::string(sequence.name) + sequence.truth, folder).at("rmse"),
            sequence.max_error);
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
  const std::string hall = "simulated_lidar_hall";
  if (mapSequence(hall, "lidar.ini", GetParam(), folder).at("frames_used") < 3) return;
  EXPECT_LT(errorOf(hall + ".gt.tum", folder).at("max"), 0.02);
}

INSTANTIATE_TEST_SUITE_P(All, HallInStrides, testing::Values("2", "4", "5", "8"),
                         [](const auto& step) { return std::string("Every") + step.param; });

}  // namespace
}  // namespace opp
