// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/checkpoint/checkpointer.h"

#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace opp::mapping {
namespace {

/// The clock goes on by `cost_` whenever a checkpoint is written: it is asked before and after.
class CheckpointerTest : public testing::Test {
 protected:
  CheckpointerTest() {
    params_.interval = 10.0;
    params_.max_share = 0.1;
  }
  Checkpointer checkpointer(const std::string& name) {
    return {folder_ / name, {}, params_, [this] {
              const double now = seconds_;
              if (std::filesystem::exists(folder_ / "checkpoint") != existed_) {
                existed_ = true;
                seconds_ += cost_;
                return std::chrono::duration<double>(seconds_);
              }
              return std::chrono::duration<double>(now);
            }};
  }
  /// Whether an update at that time writes.
  bool writes(Checkpointer& checkpoints, double seconds) {
    std::filesystem::remove(folder_ / "checkpoint");
    existed_ = false;
    seconds_ = seconds;
    checkpoints.update(run_);
    return std::filesystem::exists(folder_ / "checkpoint");
  }

  test::TempFolder folder_;
  CheckpointParams params_;
  MappingRun run_{MapperParams()};
  double seconds_ = 100.0;
  double cost_ = 0.5;
  bool existed_ = false;
};

TEST_F(CheckpointerTest, WritesOnceAnInterval) {
  Checkpointer checkpoints = checkpointer("checkpoint");
  EXPECT_FALSE(writes(checkpoints, 109.0));
  EXPECT_TRUE(writes(checkpoints, 110.0));
  EXPECT_FALSE(writes(checkpoints, 120.0)) << "counted from the end of the last";
  EXPECT_TRUE(writes(checkpoints, 120.5));
  EXPECT_DOUBLE_EQ(run_.report.seconds.at("checkpoints"), 1.0);
}

TEST_F(CheckpointerTest, WritesSeldomWhatTakesLong) {
  Checkpointer checkpoints = checkpointer("checkpoint");
  cost_ = 4.0;
  EXPECT_TRUE(writes(checkpoints, 110.0));
  EXPECT_FALSE(writes(checkpoints, 153.0)) << "4 s are a tenth of 40 s";
  EXPECT_TRUE(writes(checkpoints, 154.0));
}

TEST_F(CheckpointerTest, WhatCannotBeWrittenIsTriedAgainAfterTheInterval) {
  Checkpointer checkpoints = checkpointer("no/folder");
  seconds_ = 110.0;
  EXPECT_THROW(checkpoints.update(run_), std::runtime_error);
  seconds_ = 119.0;
  EXPECT_NO_THROW(checkpoints.update(run_));
  seconds_ = 120.0;
  EXPECT_THROW(checkpoints.update(run_), std::runtime_error);
}

TEST_F(CheckpointerTest, RestoresWhatItSaved) {
  Checkpointer checkpoints = checkpointer("checkpoint");
  MappingRun read{MapperParams()};
  EXPECT_FALSE(checkpoints.restore(read)) << "there is none";
  run_.sessions_read = 3;
  checkpoints.save(run_);
  EXPECT_TRUE(checkpoints.restore(read));
  EXPECT_EQ(read.sessions_read, 3U);
}

}  // namespace
}  // namespace opp::mapping
