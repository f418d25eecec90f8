// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/checkpoint/checkpoint_file.h"

#include "support/random.h"
#include "support/synthetic_features.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

namespace opp::mapping {
namespace {

using testing::HasSubstr;

const RunIdentity kIdentity = {{"--every", "1"}, {"rawlog 1", "a.rawlog"}};

/// All that can happen to a run, scan by scan: it is lost when it comes to another room, and maps a
/// second session.
class Journey {
 public:
  static constexpr int kScans = 44;

  Journey() {
    for (int step = 0; step < kScans; ++step) {
      scans_.push_back(test::scanOfRoom(roomAt(step), step, test::poseOnCircle(step)));
      scans_.back().session = sessionAt(step);
      scans_.back().scan_index = static_cast<std::size_t>(step);
    }
  }

  FrameResult map(int step, MappingRun& run) const {
    const ScanFeatures& scan = scans_[static_cast<std::size_t>(step)];
    if (step == 0) run.mapper.setInitialPose(test::poseOnCircle(0));
    if (step == kSecondSession) run.mapper.startSession();
    run.report.sessions.resize(static_cast<std::size_t>(sessionAt(step)) + 1);
    SessionReport& session = run.report.sessions.back();
    ++session.frames_read;
    session.scans.push_back({scan.scan_index, scan.timestamp});
    // Odometry comes and goes.
    std::optional<Eigen::Isometry3d> odom_from_body;
    if (step / 8 % 2 == 1) odom_from_body = test::poseOnCircle(step);
    return run.mapper.add(scan, odom_from_body);
  }

 private:
  static constexpr int kOtherRoom = 15, kSecondSession = 30;
  static std::uint64_t roomAt(int step) {
    return step < kOtherRoom || step >= kSecondSession ? 1 : 2;
  }
  static int sessionAt(int step) { return step < kSecondSession ? 0 : 1; }

  std::vector<ScanFeatures> scans_;
};

class CheckpointFile : public testing::Test {
 protected:
  /// All of a run's state.
  std::string bytesOf(const MappingRun& run) const {
    writeCheckpoint(folder_ / "bytes", kIdentity, run);
    return test::readFile(folder_ / "bytes");
  }
  /// The run that takes up what `run` left.
  std::unique_ptr<MappingRun> resumed(const MappingRun& run) const {
    writeCheckpoint(file(), kIdentity, run);
    auto result = std::make_unique<MappingRun>(MapperParams());
    readCheckpoint(file(), kIdentity, *result);
    return result;
  }
  /// What reading a checkpoint of these bytes says.
  std::string messageOf(const std::string& bytes, const RunIdentity& identity = kIdentity) const {
    test::writeFile(file(), bytes);
    MappingRun run{MapperParams()};
    try {
      readCheckpoint(file(), identity, run);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no std::runtime_error";
  }
  /// A run of a few scans.
  std::string someBytes() const {
    MappingRun run{MapperParams()};
    run.mapper.add(test::scanOfRoom(1, 0, test::poseOnCircle(0)), std::nullopt);
    run.report.sessions.emplace_back().path = "a.rawlog";
    return bytesOf(run);
  }
  std::filesystem::path file() const { return folder_ / "checkpoint"; }

  test::TempFolder folder_;
};

TEST_F(CheckpointFile, RunThatIsResumedAfterEachScanIsTheSameToTheBit) {
  const Journey journey;
  MappingRun whole{MapperParams()};
  auto pieces = std::make_unique<MappingRun>(MapperParams());
  int lost = 0, keyframes = 0;
  for (int step = 0; step < Journey::kScans; ++step) {
    const FrameResult result = journey.map(step, whole);
    lost += result.localized ? 0 : 1;
    keyframes += result.is_keyframe ? 1 : 0;
    journey.map(step, *pieces);
    pieces = resumed(*pieces);
    ASSERT_EQ(bytesOf(*pieces), bytesOf(whole)) << "scan " << step;
  }
  EXPECT_GE(lost, MapperParams().loop.lost_scans - 1);
  EXPECT_GE(keyframes, 6);
  EXPECT_LT(keyframes, Journey::kScans - lost) << "some scans are none";
  EXPECT_EQ(whole.mapper.parts().size(), 3U) << "a room, another room, another session";
  for (MappingRun* run : {&whole, pieces.get()}) {
    run->mapper.finish();
    run->finished = true;
  }
  EXPECT_EQ(bytesOf(*pieces), bytesOf(whole)) << "finished";
  EXPECT_EQ(bytesOf(*resumed(*pieces)), bytesOf(whole)) << "resumed after that";
  EXPECT_EQ(resumed(*pieces)->mapper.map().scans.size(), whole.mapper.map().scans.size());
}

TEST_F(CheckpointFile, KeepsTheReport) {
  MappingRun run{MapperParams()};
  run.report.sessions.resize(2);
  SessionReport& session = run.report.sessions.back();
  session = {"b.rawlog", 12, "c0ffee", 9, 5, 2, 1, 4, 1.5, 3, {{7, 0.25}}};
  run.report.counts = {{"planes", 6}};
  run.report.seconds = {{"frames", 1.25}};
  run.report.warnings = {"", "with \"quotes\"\n"};
  run.sessions_read = 1;
  run.finished = true;
  const auto read = resumed(run);
  ASSERT_EQ(read->report.sessions.size(), 2U);
  EXPECT_EQ(read->report.sessions.back().path, "b.rawlog");
  EXPECT_EQ(read->report.sessions.back().bytes, 12U);
  EXPECT_EQ(read->report.sessions.back().sha256, "c0ffee");
  EXPECT_EQ(read->report.sessions.back().path_length, 1.5);
  ASSERT_EQ(read->report.sessions.back().scans.size(), 1U);
  EXPECT_EQ(read->report.sessions.back().scans.front().scan_index, 7U);
  EXPECT_EQ(read->report.counts, run.report.counts);
  EXPECT_EQ(read->report.seconds, run.report.seconds);
  EXPECT_EQ(read->report.warnings, run.report.warnings);
  EXPECT_EQ(read->sessions_read, 1U);
  EXPECT_TRUE(read->finished);
}

TEST_F(CheckpointFile, RunOfNothingIsKept) {
  const MappingRun nothing{MapperParams()};
  EXPECT_EQ(bytesOf(*resumed(nothing)), bytesOf(nothing));
}

TEST_F(CheckpointFile, DamageIsNamedWhereverItIs) {
  const std::string whole = someBytes();
  ASSERT_EQ(messageOf(whole), "no std::runtime_error");
  test::Random random(3);
  for (int trial = 0; trial < 60; ++trial) {
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(whole.size()) - 1));
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << random.integer(0, 7)));
    for (const std::string& bytes : {flipped, whole.substr(0, at), whole + flipped}) {
      const std::string message = messageOf(bytes);
      EXPECT_THAT(message, HasSubstr(file().string() + ": it is damaged")) << "byte " << at;
      EXPECT_THAT(message, HasSubstr("without --resume"));
    }
  }
  for (const std::string& bytes : {std::string(), std::string("x"), std::string(5000, '\0')})
    EXPECT_THAT(messageOf(bytes), HasSubstr("it is damaged"));
}

TEST_F(CheckpointFile, AnotherRunIsRefusedByWhatDiffers) {
  const std::string bytes = someBytes();
  EXPECT_THAT(messageOf(bytes, {{"--every", "2"}, {"rawlog 1", "a.rawlog"}}),
              testing::AllOf(HasSubstr(file().string()), HasSubstr("--every is 2, was 1"),
                             HasSubstr("without --resume")));
  EXPECT_EQ(test::readFile(file()), bytes) << "it is not lost by that";
}

TEST_F(CheckpointFile, MissingOneIsAnError) {
  MappingRun run{MapperParams()};
  EXPECT_THROW(readCheckpoint(folder_ / "none", kIdentity, run), std::runtime_error);
  EXPECT_THROW(writeCheckpoint(folder_ / "no/folder", kIdentity, run), std::runtime_error);
}

}  // namespace
}  // namespace opp::mapping
