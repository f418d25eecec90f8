// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/random.h"
#include "support/run_command.h"
#include "support/synthetic_room.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <set>
#include <sstream>

namespace opp::test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

/// A scan of `scene` as text: points with normals, in a frame whose origin is the viewpoint.
std::string scan(const Rectangles& scene, const Eigen::Vector3d& eye,
                 const Eigen::Matrix3d& sensor_from_scene, std::uint64_t seed) {
  SyntheticOptions options;
  options.spacing = 0.06;
  options.sigma = 0.002;
  options.seed = seed;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = sensor_from_scene;
  pose.translation() = -sensor_from_scene * eye;
  const OrientedCloud cloud = sampleScene(scene, eye, pose, options).cloud;
  std::ostringstream os;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    os << cloud.points[i].transpose() << ' ' << cloud.normals[i].transpose() << '\n';
  }
  return os.str();
}

Json answerOf(const std::vector<std::string>& arguments) {
  const CommandResult result = runApp("opp-register", arguments);
  EXPECT_EQ(result.exit_code, 0) << result;
  return Json::parse(result.out, nullptr, false);
}

Eigen::Isometry3d poseOf(const Json& json) {
  Eigen::Isometry3d pose;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) pose.matrix()(r, c) = json.at("target_from_source").at(r).at(c);
  }
  return pose;
}

class OppRegister : public testing::Test {
 protected:
  OppRegister() : target_eye_(0.4, 0.2, 1.3), source_eye_(-0.3, 0.1, 1.2) {
    Random random(1);
    rotation_ = random.pose(1.0).linear();
    const Rectangles room = furnishedRoom(3);
    writeFile(folder_ / "a.xyz", scan(room, target_eye_, Eigen::Matrix3d::Identity(), 1));
    writeFile(folder_ / "b.xyz", scan(room, source_eye_, rotation_, 2));
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  void expectTruth(const Json& answer) const {
    ASSERT_TRUE(answer.at("success").get<bool>()) << answer;
    const Eigen::Isometry3d pose = poseOf(answer);
    // 2 mm of noise on thousands of samples.
    EXPECT_LT((pose.linear() - rotation_.transpose()).norm(), 0.01) << answer;
    EXPECT_LT((pose.translation() - (source_eye_ - target_eye_)).norm(), 0.015) << answer;
    EXPECT_TRUE(answer.at("reason").is_null());
    EXPECT_GT(answer.at("overlap").get<double>(), 0.5);
    EXPECT_LT(answer.at("rmse_m").get<double>(), 0.02);
    EXPECT_EQ(answer.at("covariance").size(), 6U);
    EXPECT_EQ(answer.at("covariance").at(5).size(), 6U);
  }

  TempFolder folder_;
  Eigen::Vector3d target_eye_, source_eye_;
  Eigen::Matrix3d rotation_;
};

TEST_F(OppRegister, FindsThePoseWithoutAGuess) {
  const Json answer = answerOf({"--target", path("a.xyz"), "--source", path("b.xyz")});
  expectTruth(answer);
  EXPECT_EQ(answer.at("mode_used"), "corners");
}

TEST_F(OppRegister, EveryModeFindsThePoseFromAGuess) {
  std::ostringstream guess;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = rotation_.transpose();
  matrix.topRightCorner<3, 1>() = source_eye_ - target_eye_ + Eigen::Vector3d(0.05, -0.03, 0.04);
  guess << "# a comment\n" << matrix << '\n';
  writeFile(folder_ / "guess.txt", guess.str());
  for (const std::string mode : {"icp", "corners", "auto"}) {
    const Json answer = answerOf({"--target", path("a.xyz"), "--source", path("b.xyz"), "--initial",
                                  path("guess.txt"), "--mode", mode});
    expectTruth(answer);
    EXPECT_EQ(answer.at("mode_used"), mode == "corners" ? "corners" : "icp");
    if (mode != "corners") {
      EXPECT_EQ(answer.at("dof"), 6);
    }
  }
}

TEST_F(OppRegister, WritesTheSameBytesForEveryNumberOfThreads) {
  std::set<std::string> answers;
  for (int k = 0; k < 10; ++k) {
    const CommandResult result =
        runApp("opp-register", {"--target", path("a.xyz"), "--source", path("b.xyz"), "--threads",
                                std::to_string(1 + k % 3), "-o", path("out.json")});
    EXPECT_EQ(result.exit_code, 0) << result;
    EXPECT_EQ(result.out, "");
    answers.insert(readFile(folder_ / "out.json"));
  }
  EXPECT_EQ(answers.size(), 1U);
}

TEST_F(OppRegister, ClaimsNothingWhereNothingTellsThePose) {
  const Rectangles plane = {{{2.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}}};
  Rectangles parallel = plane;
  parallel.push_back({{-2.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}});
  const Rectangles room = roomSides({-2.5, -1.8, 0.0}, {2.5, 1.8, 2.4});
  const Eigen::Matrix3d same = Eigen::Matrix3d::Identity();
  writeFile(folder_ / "plane.xyz", scan(plane, {0, 0, 0}, same, 1));
  writeFile(folder_ / "parallel.xyz", scan(parallel, {0, 0, 0}, same, 1));
  writeFile(folder_ / "room.xyz", scan(room, {0.3, 0.2, 1.2}, same, 1));
  writeFile(folder_ / "turned.xyz", scan(room, {-0.5, 0.1, 1.2}, rotation_, 2));
  writeFile(folder_ / "none.xyz", "# nothing\n");
  const std::vector<std::array<std::string, 3>> cases = {
      {"plane.xyz", "plane.xyz", "six degrees of freedom"},
      {"parallel.xyz", "parallel.xyz", "six degrees of freedom"},
      {"room.xyz", "turned.xyz", "several distinct poses"},
      {"none.xyz", "a.xyz", "the target holds no surface"},
      {"a.xyz", "none.xyz", "the source holds no surface"}};
  for (const auto& [target, source, reason] : cases) {
    const Json answer = answerOf({"--target", path(target), "--source", path(source)});
    EXPECT_FALSE(answer.at("success").get<bool>()) << target;
    EXPECT_THAT(answer.at("reason").get<std::string>(), HasSubstr(reason)) << target;
    EXPECT_TRUE(answer.at("target_from_source").is_null());
    EXPECT_TRUE(answer.at("covariance").is_null());
  }
}

TEST_F(OppRegister, PlainIcpClaimsNothingWhereAPlaneLeavesThreeDirections) {
  const Rectangles plane = {{{2.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}}};
  writeFile(folder_ / "plane.xyz", scan(plane, {0, 0, 0}, Eigen::Matrix3d::Identity(), 1));
  const Json answer =
      answerOf({"--target", path("plane.xyz"), "--source", path("plane.xyz"), "--mode", "icp"});
  EXPECT_FALSE(answer.at("success").get<bool>()) << answer;
  EXPECT_EQ(answer.at("mode_used"), "icp");
}

TEST_F(OppRegister, BadInputIsAnErrorAndWritesNothing) {
  writeFile(folder_ / "bad.ply", std::string("\x7f\x01random\xff", 9));
  writeFile(folder_ / "empty.rawlog", "");
  const std::vector<std::string> before = folder_.contents();
  for (const char* name : {"missing.ply", "bad.ply", "empty.rawlog"}) {
    for (const bool as_target : {true, false}) {
      const CommandResult result =
          runApp("opp-register", {"--target", path(as_target ? name : "a.xyz"), "--source",
                                  path(as_target ? "b.xyz" : name), "-o", path("out.json")});
      EXPECT_EQ(result.exit_code, 1) << result;
      EXPECT_EQ(result.out, "");
      EXPECT_THAT(result.err, HasSubstr(name));
    }
  }
  EXPECT_EQ(folder_.contents(), before);
}

TEST_F(OppRegister, ABadGuessIsToldWithFileAndPlace) {
  const std::vector<std::array<std::string, 2>> cases = {
      {"1 0 0 0\n0 1 zero 0\n", "guess.txt:2: 'zero'"},
      {"1 0 0 0\n0 1 0 0\n", "guess.txt: holds 8 numbers"},
      {"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n5\n", "guess.txt:5: more than 16"},
      {"2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n", "guess.txt: is not a rotation"},
      {"-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "guess.txt: is not a rotation"},
      {"nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "guess.txt:1: 'nan'"}};
  for (const auto& [text, message] : cases) {
    writeFile(folder_ / "guess.txt", text);
    const CommandResult result = runApp(
        "opp-register",
        {"--target", path("a.xyz"), "--source", path("b.xyz"), "--initial", path("guess.txt")});
    EXPECT_EQ(result.exit_code, 1) << result;
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_THAT(result.err, HasSubstr("4x4"));
  }
}

TEST_F(OppRegister, WrongUsageIsToldApart) {
  const std::string a = path("a.xyz"), b = path("b.xyz");
  EXPECT_EQ(runApp("opp-register", {"--target", a}).exit_code, 2);
  EXPECT_EQ(runApp("opp-register", {"--target", a, "--source", b, "--mode", "magic"}).exit_code, 2);
  EXPECT_EQ(runApp("opp-register", {"--target", a, "--source", b, "--source-index", "1"}).exit_code,
            2);
}

}  // namespace
}  // namespace opp::test
