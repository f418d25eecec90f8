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
};

class RecordedSequence : public testing::TestWithParam<Sequence> {};

TEST_P(RecordedSequence, EveryTenthFrameIsLocalizedWithinOneAndAHalfCentimetres) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const test::TempFolder folder;
  const auto file = [&](const char* extension) {
    return test::sharedData(std::string(GetParam().name) + extension).string();
  };
  const test::CommandResult map =
      test::runApp("opp-map", {"-i", file(".rawlog"), "-o", (folder / "map").string(), "-c",
                               OPP_SOURCE_FOLDER "/config/rgbd.ini", "--every", "10",
                               "--no-octomap", "--quiet"});
  ASSERT_EQ(map.exit_code, 0) << map;
  const auto report = nlohmann::json::parse(test::readFile(folder / "map/run.json"));
  EXPECT_EQ(report.at("sessions").at(0).at("frames_lost"), 0);
  const test::CommandResult eval =
      test::runApp("opp-eval", {"--gt", file(GetParam().truth), "--est",
                                (folder / "map/trajectory.tum").string(), "--json"});
  ASSERT_EQ(eval.exit_code, 0) << eval;
  const auto error = nlohmann::json::parse(eval.out).at("trajectory");
  // What point-to-model registration reaches on these sequences, with some room.
  EXPECT_LT(error.at("ate").at("translation_m").at("rmse"), 0.015);
}

INSTANTIATE_TEST_SUITE_P(All, RecordedSequence,
                         testing::Values(Sequence{"tum_fr3_structure_notexture_far", ".gt.tum"},
                                         Sequence{"icl_of_kt3", ".gt.tum"},
                                         Sequence{"redwood_livingroom1", ".ref.tum"}),
                         [](const auto& sequence) { return std::string(sequence.param.name); });

}  // namespace
}  // namespace opp
