// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/run_command.h"
#include "support/shared_data.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace opp::test {
namespace {

using Json = nlohmann::json;

Eigen::Isometry3d poseOf(const Json& json) {
  Eigen::Isometry3d pose;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) pose.matrix()(r, c) = json.at("target_from_source").at(r).at(c);
  }
  return pose;
}

Json answerOf(const std::vector<std::string>& arguments) {
  const CommandResult result = runApp("opp-register", arguments);
  EXPECT_EQ(result.exit_code, 0) << result;
  return Json::parse(result.out, nullptr, false);
}

TEST(OppRegisterData, AlignsThePolyhedronToItsGivenPose) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const auto file = [](const std::string& name) {
    return sharedData("fixtures/polyhedron_" + name).string();
  };
  const Json answer = answerOf({"--target", file("target.ply"), "--source", file("source.ply")});
  ASSERT_TRUE(answer.at("success").get<bool>()) << answer;
  Eigen::Isometry3d truth;
  std::ifstream stream(file("target_from_source.txt"));
  for (int k = 0; k < 16; ++k) ASSERT_TRUE(stream >> truth.matrix()(k / 4, k % 4));
  const Eigen::Isometry3d error = truth.inverse() * poseOf(answer);
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle() * 180.0 / 3.14159265, 1.0);
  EXPECT_LT(error.translation().norm(), 0.01);  // 1 % of its size, 1.1 m
}

TEST(OppRegisterData, AlignsObservationsOfARawlog) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const std::string rawlog = sharedData("icl_of_kt3.rawlog").string();
  const std::vector<std::string> pair = {"--target", rawlog,           "--source",
                                         rawlog,     "--source-index", "60"};
  const Json answer = answerOf(pair);
  ASSERT_TRUE(answer.at("success").get<bool>()) << answer;
  // The same pair the other way around.
  const Json back = answerOf({"--target", rawlog, "--source", rawlog, "--target-index", "60"});
  ASSERT_TRUE(back.at("success").get<bool>()) << back;
  const Eigen::Isometry3d loop = poseOf(answer) * poseOf(back);
  EXPECT_LT(Eigen::AngleAxisd(loop.linear()).angle(), 0.005);
  EXPECT_LT(loop.translation().norm(), 0.01);
}

/// The bytes of ten answers, with one to four threads and as many as there are cores.
std::set<std::string> tenAnswers(const std::vector<std::string>& arguments) {
  std::set<std::string> answers;
  for (int k = 0; k < 10; ++k) {
    std::vector<std::string> all = arguments;
    if (k % 5 != 0) all.insert(all.end(), {"--threads", std::to_string(k % 5)});
    const CommandResult result = runApp("opp-register", all);
    EXPECT_EQ(result.exit_code, 0) << result;
    answers.insert(result.out);
  }
  return answers;
}

TEST(OppRegisterData, TenRunsWithAnyThreadsGiveTheSameBytes) {
  OPP_SKIP_WITHOUT_SHARED_DATA();
  const auto pair = [](const std::string& name, const std::string& source_index) {
    const std::string rawlog = sharedData(name + ".rawlog").string();
    return std::vector<std::string>{"--target", rawlog,           "--source",
                                    rawlog,     "--source-index", source_index};
  };
  // A real camera's scans that are aligned, and two of a symmetric hall, where no pose is claimed.
  for (const auto& [arguments, aligned] :
       {std::pair{pair("tum_fr3_structure_notexture_far", "60"), true},
        std::pair{pair("simulated_lidar_hall", "10"), false}}) {
    for (const std::string mode : {"auto", "corners"}) {
      std::vector<std::string> all = arguments;
      all.insert(all.end(), {"--mode", mode});
      const std::set<std::string> answers = tenAnswers(all);
      ASSERT_EQ(answers.size(), 1U) << mode;
      EXPECT_EQ(Json::parse(*answers.begin()).at("success"), aligned) << *answers.begin();
    }
  }
}

}  // namespace
}  // namespace opp::test
