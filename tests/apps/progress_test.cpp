// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "common/progress.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

namespace opp::apps {
namespace {

class ProgressTest : public testing::Test {
 protected:
  Progress make(Progress::Mode mode) {
    return {"mapping", "frames", mode, out_,
            [this] { return std::chrono::duration<double>(seconds_); }};
  }
  std::ostringstream out_;
  double seconds_ = 100.0;
};

TEST_F(ProgressTest, SaysShareRateAndTimeLeftEveryFewSeconds) {
  Progress progress = make(Progress::Mode::kLines);
  progress.update(0.1, 10);
  EXPECT_EQ(out_.str(), "");
  seconds_ += 6.0;
  progress.update(0.25, 30);
  EXPECT_EQ(out_.str(), "mapping:  25 %, 30 frames, 5.0 frames/s, 0:18 left\n");
  seconds_ += 1.0;
  progress.update(0.3, 31);
  EXPECT_EQ(out_.str().size(), 51U) << "one second later is too early";
}

TEST_F(ProgressTest, EndsWithCountTimeAndRate) {
  Progress progress = make(Progress::Mode::kLines);
  seconds_ += 4.0;
  progress.update(1.0, 50);
  progress.finish();
  EXPECT_EQ(out_.str(), "mapping: 50 frames in 4.0 s, 12.5 frames/s\n");
}

TEST_F(ProgressTest, BarIsRedrawnInPlace) {
  Progress progress = make(Progress::Mode::kTerminal);
  seconds_ += 4000.0;
  progress.update(0.5, 8000);
  progress.log("a warning");
  EXPECT_EQ(out_.str(),
            "\r\x1b[Kmapping [############............]  50 %, 8000 frames, 2.0 frames/s, "
            "1:06:40 left\r\x1b[Ka warning\n");
}

TEST_F(ProgressTest, SilentWritesNothing) {
  Progress progress = make(Progress::Mode::kSilent);
  seconds_ += 100.0;
  progress.update(0.5, 1);
  progress.log("line");
  progress.finish();
  EXPECT_EQ(out_.str(), "");
  EXPECT_EQ(Progress::modeFor(true), Progress::Mode::kSilent);
}

TEST_F(ProgressTest, OddFractionsAreHarmless) {
  Progress progress = make(Progress::Mode::kTerminal);
  for (const double fraction : {std::numeric_limits<double>::quiet_NaN(), -1.0, 2.0,
                                std::numeric_limits<double>::infinity()}) {
    seconds_ += 1.0;
    progress.update(fraction, 0);
  }
  EXPECT_EQ(out_.str().find("nan"), std::string::npos);
  EXPECT_EQ(out_.str().find("200 %"), std::string::npos);
}

}  // namespace
}  // namespace opp::apps
