// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/random.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <sstream>
#include <string>

namespace opp::test {
namespace {

using testing::HasSubstr;

const std::string kDemo = OPP_SOURCE_FOLDER "/rawlogs/demo.rawlog";

class OppMap : public testing::Test {
 protected:
  /// Runs opp-map into folder_/out.
  CommandResult map(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"-o", (folder_ / "out").string(), "--quiet"});
    return runApp("opp-map", arguments);
  }
  TempFolder folder_;
};

TEST_F(OppMap, WrongUsageIsExitCode2AndWritesNothing) {
  const std::vector<std::vector<std::string>> calls = {
      {},
      {"--bogus"},
      {"-i", kDemo, "stray"},
      {"-i", kDemo, "--threads", "0"},
      {"-i", kDemo, "--every", "0"},
      {"-i", kDemo, "--from-index", "-1"},
      {"-i", kDemo, "--from-index", "many"},
      {"-i", kDemo, "--resolution", "-0.05"},
      {"-i", kDemo, "--resolution", "5 cm"},
      {"-i", kDemo, "--sensor-label", "("},
      {"-i", kDemo, "--set", "sensor.max_range=far"},
      {"-i", kDemo, "--set", "frontend.keyframe_rotation=10"}};
  for (const auto& call : calls) {
    const CommandResult result = map(call);
    EXPECT_EQ(result.exit_code, 2) << testing::PrintToString(call) << '\n' << result;
    EXPECT_THAT(result.err, testing::StartsWith("opp-map: ")) << testing::PrintToString(call);
    EXPECT_EQ(result.out, "");
  }
  EXPECT_EQ(runApp("opp-map", {"-i", kDemo}).exit_code, 2) << "-o is missing";
  EXPECT_TRUE(folder_.contents().empty());
}

TEST_F(OppMap, BadRawlogIsExitCode1NamesTheFileAndWritesNothing) {
  Random random(5);
  std::string noise;
  for (int i = 0; i < 20000; ++i) noise += static_cast<char>(random.integer(-128, 127));
  const std::string bad = (folder_ / "bad.rawlog").string();
  for (const std::string& bytes :
       {std::string(), noise, std::string("some text\n"), "\x1f\x8b" + noise}) {
    writeFile(bad, bytes);
    const CommandResult result = map({"-i", bad});
    EXPECT_EQ(result.exit_code, 1) << result;
    EXPECT_THAT(result.err, HasSubstr(bad));
    EXPECT_EQ(result.out, "");
  }
  const std::string missing = (folder_ / "missing.rawlog").string();
  EXPECT_EQ(map({"-i", missing}).exit_code, 1);
  EXPECT_THAT(map({"-i", missing}).err, HasSubstr(missing));
  EXPECT_EQ(map({"-i", folder_.path().string()}).exit_code, 1) << "a folder";
  EXPECT_EQ(folder_.contents(), std::vector<std::string>{"bad.rawlog"});
}

TEST_F(OppMap, BadConfigurationIsExitCode1AndWritesNothing) {
  const std::string bad = (folder_ / "bad.ini").string();
  writeFile(bad, "[sensor]\nmax_rnge = 3 m\n");
  const CommandResult result = map({"-i", kDemo, "-c", bad});
  EXPECT_EQ(result.exit_code, 1) << result;
  EXPECT_THAT(result.err, HasSubstr(bad + ":2: [sensor] max_rnge"));
  EXPECT_EQ(map({"-i", kDemo, "-c", (folder_ / "no.ini").string()}).exit_code, 1);
  EXPECT_EQ(folder_.contents(), std::vector<std::string>{"bad.ini"});
}

TEST_F(OppMap, NoObservationSelectedIsExitCode1AndWritesNothing) {
  EXPECT_EQ(map({"-i", kDemo, "--sensor-label", "NO_SUCH_SENSOR"}).exit_code, 1);
  EXPECT_EQ(map({"-i", kDemo, "--from-index", "100000"}).exit_code, 1);
  EXPECT_TRUE(folder_.contents().empty());
}

TEST_F(OppMap, SessionsOfOnePlaceBecomeOneMap) {
  const CommandResult result =
      map({"-i", kDemo, "-i", kDemo, "--every", "2", "--no-octomap", "--to-index", "38"});
  ASSERT_EQ(result.exit_code, 0) << result;
  const auto run = nlohmann::json::parse(readFile(folder_ / "out/run.json"));
  ASSERT_EQ(run["sessions"].size(), 2U);
  EXPECT_EQ(run["counts"]["maps"], 1) << run["warnings"];
  for (const auto& session : run["sessions"]) {
    EXPECT_EQ(session["frames_read"], 19);
    EXPECT_EQ(session["frames_used"], 19);
    EXPECT_EQ(session["frames_apart"], 0);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/parts"));
  // Both sessions saw the same: scan by scan the two poses must agree.
  std::map<std::string, Eigen::Vector3d> first;
  std::istringstream lines(readFile(folder_ / "out/trajectory.tum"));
  std::string line;
  int compared = 0;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string time;
    Eigen::Vector3d position;
    if (!(fields >> time >> position.x() >> position.y() >> position.z())) continue;
    const auto [entry, is_first] = first.emplace(time, position);
    if (is_first) continue;
    ++compared;
    EXPECT_LT((position - entry->second).norm(), 0.01) << time;
  }
  EXPECT_EQ(compared, 19);
}

TEST_F(OppMap, FinishedRunIsKeptUnlessForced) {
  const std::vector<std::string> few = {"-i", kDemo, "--to-index", "3", "--no-octomap"};
  ASSERT_EQ(map(few).exit_code, 0);
  const std::string before = readFile(folder_ / "out/trajectory.tum");
  const CommandResult refused = map({"-i", kDemo, "--to-index", "2", "--no-octomap"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  EXPECT_EQ(map({"-i", "/no/such.rawlog", "--force"}).exit_code, 1);
  EXPECT_EQ(readFile(folder_ / "out/trajectory.tum"), before) << "a failed run lost a good one";
  EXPECT_EQ(map({"-i", kDemo, "--to-index", "2", "--no-octomap", "--force"}).exit_code, 0);
  EXPECT_LT(readFile(folder_ / "out/trajectory.tum").size(), before.size());
}

TEST_F(OppMap, ReportHasEveryWarningEscaped) {
  const std::string cut = (folder_ / "a<b>&\"c'.rawlog").string();
  const std::string whole = readFile(kDemo);
  writeFile(cut, whole.substr(0, whole.size() / 8));
  const CommandResult result = map({"-i", cut, "--no-octomap"});
  ASSERT_EQ(result.exit_code, 0) << result;
  const auto run = nlohmann::json::parse(readFile(folder_ / "out/run.json"));
  ASSERT_FALSE(run["warnings"].empty()) << "a damaged rawlog";
  const std::string page = readFile(folder_ / "out/report.html");
  for (const auto& warning : run["warnings"]) {
    std::string text;
    for (const char letter : warning.get<std::string>()) {
      const std::map<char, std::string> names = {
          {'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
      text += names.count(letter) == 1 ? names.at(letter) : std::string(1, letter);
    }
    EXPECT_NE(page.find("<li>" + text + "</li>"), std::string::npos) << text;
  }
  EXPECT_NE(page.find("a&lt;b&gt;&amp;&quot;c&#39;.rawlog"), std::string::npos);
  EXPECT_EQ(page.find("a<b>"), std::string::npos);
}

}  // namespace
}  // namespace opp::test
