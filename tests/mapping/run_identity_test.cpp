// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/checkpoint/run_identity.h"

#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>

namespace opp::mapping {
namespace {

namespace fs = std::filesystem;

/// What identifies a run.
struct Inputs {
  std::vector<fs::path> rawlogs;
  std::optional<fs::path> poses;
  RawlogOptions selection;
  MapperParams params;

  RunIdentity identity() const { return identityOf(rawlogs, poses, selection, params); }
};

class RunIdentityOf : public testing::Test {
 protected:
  RunIdentityOf() {
    for (const auto* name : {"a", "b"}) test::writeFile(folder_ / name, "12345");
    inputs_.rawlogs = {folder_ / "a"};
  }
  /// How the identity differs once the inputs have changed.
  std::string after(const std::function<void(Inputs&)>& change) const {
    Inputs changed = inputs_;
    const RunIdentity before = changed.identity();
    change(changed);
    return differenceOf(changed.identity(), before).value_or("equal");
  }
  test::TempFolder folder_;
  Inputs inputs_;
};

TEST_F(RunIdentityOf, EqualInputsHaveNoDifference) {
  EXPECT_EQ(after([](Inputs&) {}), "equal");
}

TEST_F(RunIdentityOf, NamesWhatDiffers) {
  const std::string a = (folder_ / "a").string(), b = (folder_ / "b").string();
  EXPECT_EQ(after([](Inputs& i) { i.selection.every = 3; }), "--every is 3, was 1");
  EXPECT_EQ(after([](Inputs& i) { i.selection.from_index = 2; }), "--from-index is 2, was 0");
  EXPECT_EQ(after([](Inputs& i) { i.selection.to_index = 9; }), "--to-index is 9, was the end");
  EXPECT_EQ(after([](Inputs& i) { i.selection.sensor_label = "K.*"; }),
            "--sensor-label is \"K.*\", was \"\"");
  EXPECT_EQ(after([](Inputs& i) { i.params.loop.lost_scans = 8; }),
            "[loop] lost_scans is 8, was 5");
  EXPECT_EQ(after([&](Inputs& i) { i.poses = b; }), "--initial-poses is " + b + ", was not there");
  EXPECT_EQ(after([&](Inputs& i) { i.rawlogs.push_back(b); }),
            "rawlog 2 is " + b + ", was not there");
  EXPECT_EQ(after([&](Inputs& i) { i.rawlogs = {b}; }), "rawlog 1 is " + b + ", was " + a);
}

TEST_F(RunIdentityOf, DoesNotDependOnHowOftenCheckpointsAreStored) {
  EXPECT_EQ(after([](Inputs& i) { i.params.checkpoint.interval = 1.0; }), "equal");
}

TEST_F(RunIdentityOf, SeesFilesThatChanged) {
  const fs::path a = folder_ / "a";
  EXPECT_THAT(after([&](Inputs&) {
                const auto time = fs::last_write_time(a);
                test::writeFile(a, "1234567");
                fs::last_write_time(a, time);
              }),
              testing::HasSubstr(a.string() + ": size is 7 bytes, was 5 bytes"));
  EXPECT_THAT(after([&](Inputs&) {
                fs::last_write_time(a, fs::last_write_time(a) + std::chrono::milliseconds(1));
              }),
              testing::HasSubstr(a.string() + ": last change is "));
}

TEST_F(RunIdentityOf, NamesAFileThatIsMissing) {
  inputs_.rawlogs.push_back(folder_ / "c");
  try {
    inputs_.identity();
    ADD_FAILURE() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr((folder_ / "c").string()));
  }
}

TEST_F(RunIdentityOf, SaysWhatIsNotThereAnyMore) {
  EXPECT_EQ(differenceOf({}, {{"x", "1"}}), "x was 1, is not there");
}

}  // namespace
}  // namespace opp::mapping
