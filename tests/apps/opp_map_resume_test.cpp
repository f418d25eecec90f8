// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/checkpoint/checkpoint_file.h"
#include "opp/mapping/pipeline/map_rawlog.h"

#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace opp::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kDemo = OPP_SOURCE_FOLDER "/rawlogs/demo.rawlog";  // a robot with odometry
const std::string kDemoPoses = OPP_SOURCE_FOLDER "/rawlogs/demo.gt.tum";
constexpr int kKilled = 128 + SIGKILL;
constexpr int kMostKills = 6;
constexpr int kFewScans = 4;

using Arguments = std::vector<std::string>;

Arguments operator+(Arguments list, const Arguments& more) {
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

class OppMapResume : public testing::Test {
 protected:
  fs::path checkpoint() const { return folder_ / "out/.unfinished/checkpoint"; }

  Arguments command(const Arguments& arguments, const std::string& out = "out") const {
    return Arguments{appPath("opp-map"), "-o", (folder_ / out).string()} + arguments;
  }
  CommandResult map(const Arguments& arguments, const std::string& out = "out") const {
    return runCommand(command(arguments, out));
  }
  /// Kills opp-map as soon as it has written a checkpoint.
  CommandResult mapUntilCheckpoint(const Arguments& arguments) const {
    const auto written = [this] {
      struct stat status {};
      return stat(checkpoint().c_str(), &status) == 0 ? status.st_ino : 0;
    };
    const ino_t before = written();
    return runCommandUntil([&] { return written() != 0 && written() != before; },
                           command(arguments));
  }

  static Arguments fewOf(const std::string& rawlog) {
    return {"-i", rawlog, "--to-index", std::to_string(kFewScans), "--no-octomap"};
  }
  /// Leaves what a run of fewOf(rawlog) does that is killed once all is mapped.
  void leaveMapped(const std::string& rawlog) const {
    mapping::MapRawlogOptions options;
    options.selection.to_index = kFewScans;
    const mapping::MapperParams params;
    mapping::MappingRun run{params};
    mapping::mapRawlog(rawlog, options, params.primitives, {}, run);
    mapping::finishMapping(run);
    fs::create_directories(checkpoint().parent_path());
    mapping::writeCheckpoint(
        checkpoint(), mapping::identityOf({rawlog}, std::nullopt, options.selection, params), run);
  }

  /// All results of a run but for times and memory.
  std::map<std::string, std::string> results(const std::string& out) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / out)) {
      const std::string name = fs::relative(entry.path(), folder_ / out).string();
      if (name == "report.html" || entry.is_directory()) continue;
      files[name] = readFile(entry.path());
    }
    auto run = nlohmann::json::parse(files["run.json"]);
    run.erase("seconds");
    run.erase("peak_memory_mb");
    files["run.json"] = run.dump();
    return files;
  }
  /// Not EXPECT_EQ of the maps, which would print megabytes.
  void expectSameResults(const std::string& a, const std::string& b) const {
    const auto of_a = results(a), of_b = results(b);
    EXPECT_EQ(of_a.size(), of_b.size());
    EXPECT_GE(of_a.size(), 9U);
    for (const auto& [name, bytes] : of_a)
      EXPECT_TRUE(of_b.count(name) == 1 && of_b.at(name) == bytes) << name;
  }

  /// A checkpoint after each scan, or about; they cost as much as that takes.
  const Arguments kOften = {"--set", "checkpoint.interval=0 s", "--set", "checkpoint.max_share=1"};
  const Arguments kFew = fewOf(kDemo);
  TempFolder folder_;
};

TEST_F(OppMapResume, KilledAgainAndAgainGivesTheSameBytes) {
  const Arguments call =
      Arguments{"-i",      kDemo, "-i",         kDemo, "--from-index",    "1",
                "--every", "2",   "--to-index", "20",  "--initial-poses", kDemoPoses} +
      kOften;
  ASSERT_EQ(map(call, "whole").exit_code, 0);
  CommandResult last = mapUntilCheckpoint(call);
  ASSERT_EQ(last.exit_code, kKilled) << last;
  // Each time with another number of threads, until it ends before it is killed.
  for (int kill = 1; kill < kMostKills && last.exit_code == kKilled; ++kill) {
    last =
        mapUntilCheckpoint(call + Arguments{"--resume", "--threads", std::to_string(1 + kill % 3)});
    EXPECT_THAT(last.err, HasSubstr("resuming"));
  }
  if (last.exit_code == kKilled) last = map(call + Arguments{"--resume"});
  ASSERT_EQ(last.exit_code, 0) << last;
  EXPECT_FALSE(fs::exists(checkpoint().parent_path()));
  expectSameResults("whole", "out");
}

TEST_F(OppMapResume, WritesResultsOnceAllIsMapped) {
  ASSERT_EQ(map(kFew, "whole").exit_code, 0);
  leaveMapped(kDemo);
  const CommandResult result = map(kFew + Arguments{"--resume"});
  ASSERT_EQ(result.exit_code, 0) << result;
  EXPECT_THAT(result.err, HasSubstr("all is mapped"));
  expectSameResults("whole", "out");
}

TEST_F(OppMapResume, ErrorAfterMappingKeepsTheCheckpointAndSaysHowToGoOn) {
  const fs::path rawlog = folder_ / "a.rawlog";
  fs::copy_file(kDemo, rawlog);
  const Arguments call = fewOf(rawlog.string());
  ASSERT_EQ(map(call, "whole").exit_code, 0);
  leaveMapped(rawlog.string());
  // For as long as the run sees it, the rawlog is the one that was mapped.
  const auto time = fs::last_write_time(rawlog);
  const std::string bytes = readFile(rawlog);
  const auto replace = [&](const std::string& by) {
    writeFile(rawlog, by);
    fs::last_write_time(rawlog, time);
  };
  replace(std::string(bytes.size(), 'x'));
  const CommandResult failed = map(call + Arguments{"--resume"});
  EXPECT_EQ(failed.exit_code, 1) << failed;
  EXPECT_THAT(failed.err, HasSubstr(rawlog.string()));
  EXPECT_THAT(failed.err, HasSubstr("--resume"));
  ASSERT_TRUE(fs::exists(checkpoint()));
  EXPECT_EQ(std::distance(fs::directory_iterator(checkpoint().parent_path()), {}), 1)
      << "half of the results is of no use";
  replace(bytes);
  const CommandResult mended = map(call + Arguments{"--resume"});
  ASSERT_EQ(mended.exit_code, 0) << mended;
  expectSameResults("whole", "out");
}

TEST_F(OppMapResume, AnotherCallOrADamagedCheckpointIsAnErrorThatLosesNothing) {
  ASSERT_EQ(mapUntilCheckpoint(kFew + kOften).exit_code, kKilled);
  const std::string bytes = readFile(checkpoint());
  const CommandResult other =
      map(kFew + kOften + Arguments{"--resume", "--set", "loop.lost_scans=7"});
  EXPECT_EQ(other.exit_code, 1) << other;
  EXPECT_THAT(other.err, testing::AllOf(HasSubstr(checkpoint().string()),
                                        HasSubstr("[loop] lost_scans is 7, was 5"),
                                        HasSubstr("without --resume")));
  EXPECT_EQ(readFile(checkpoint()), bytes);
  const std::string half = bytes.substr(0, bytes.size() / 2);
  writeFile(checkpoint(), half);
  const CommandResult damaged = map(kFew + kOften + Arguments{"--resume"});
  EXPECT_EQ(damaged.exit_code, 1) << damaged;
  EXPECT_THAT(damaged.err, testing::AllOf(HasSubstr(checkpoint().string()), HasSubstr("damaged"),
                                          HasSubstr("without --resume")));
  EXPECT_EQ(readFile(checkpoint()), half);
  EXPECT_EQ(map(kFew + kOften).exit_code, 0) << "without --resume it is of no concern";
  EXPECT_FALSE(fs::exists(checkpoint()));
}

TEST_F(OppMapResume, NothingToResumeBeginsAndAFinishedRunIsRefused) {
  const CommandResult first = map(kFew + Arguments{"--resume"});
  ASSERT_EQ(first.exit_code, 0) << first;
  EXPECT_THAT(first.err, HasSubstr("nothing to resume in " + (folder_ / "out").string()));
  const CommandResult again = map(kFew + Arguments{"--resume"});
  EXPECT_EQ(again.exit_code, 1) << again;
  EXPECT_THAT(again.err, HasSubstr("--force"));
  EXPECT_EQ(map(kFew + Arguments{"--resume", "--force"}).exit_code, 0);
  EXPECT_THAT(runApp("opp-map", {"--help"}).out, HasSubstr("--resume"));
}

/// Maps the demo as two sessions, and stops with an exception after some scans in all.
struct Stopped {};
void mapDemo(int scans_until_stop, int threads, mapping::MappingRun& run) {
  mapping::MapRawlogOptions options;
  options.selection.to_index = 8;
  options.threads = threads;
  const auto stop = [&](double, std::size_t) {
    if (--scans_until_stop == 0) throw Stopped();
  };
  while (run.sessions_read < 2) mapping::mapRawlog(kDemo, options, PrimitiveParams(), stop, run);
  mapping::finishMapping(run);
}

TEST(MapRawlog, GoesOnFromEachScanToTheSameRun) {
  const TempFolder folder;
  const auto bytesOf = [&](mapping::MappingRun& run) {
    run.report.seconds.clear();
    writeCheckpoint(folder / "run", {}, run);
    return readFile(folder / "run");
  };
  mapping::MappingRun whole{mapping::MapperParams()};
  mapDemo(-1, 2, whole);
  EXPECT_EQ(whole.report.sessions.back().frames_read, 8U);
  for (const int scans : {1, 3, 7}) {
    auto run = std::make_unique<mapping::MappingRun>(mapping::MapperParams());
    int stops = 0;
    while (!run->finished) {
      try {
        mapDemo(scans, 1 + stops % 3, *run);
      } catch (const Stopped&) {
        ++stops;
        writeCheckpoint(folder / "checkpoint", {}, *run);
        run = std::make_unique<mapping::MappingRun>(mapping::MapperParams());
        readCheckpoint(folder / "checkpoint", {}, *run);
      }
    }
    EXPECT_EQ(stops, 16 / scans);
    EXPECT_TRUE(bytesOf(*run) == bytesOf(whole)) << "a break after every " << scans << " scans";
  }
}

}  // namespace
}  // namespace opp::test
