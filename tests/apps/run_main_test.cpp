// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "common/run_main.h"

#include "opp/mapping/core/mapper_params.h"

#include "common/flags.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <vector>

namespace opp::apps {
namespace {

using testing::HasSubstr;

struct Outcome {
  int exit_code;
  std::string out;
  std::string err;
};

Outcome callMain(std::vector<const char*> arguments, const std::function<void(CommandLine&)>& run) {
  arguments.insert(arguments.begin(), "/some/path/opp-test");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int exit_code =
      runMain(static_cast<int>(arguments.size()), arguments.data(), "opp-test", "Tests.", run);
  const std::string out = testing::internal::GetCapturedStdout();
  return {exit_code, out, testing::internal::GetCapturedStderr()};
}

template <typename Error>
Outcome callAndThrow(const Error& error) {
  return callMain({}, [&](CommandLine& line) {
    line.parse();
    throw error;
  });
}

TEST(RunMain, ExitCodesAreThoseOfTheContract) {
  EXPECT_EQ(callMain({}, [](CommandLine& line) { line.parse(); }).exit_code, 0);
  EXPECT_EQ(callAndThrow(std::runtime_error("no such file")).exit_code, 1);
  EXPECT_EQ(callAndThrow(std::invalid_argument("bad value")).exit_code, 1);
  EXPECT_EQ(callAndThrow(std::bad_alloc()).exit_code, 1);
  EXPECT_EQ(callAndThrow(UsageError("bad flag")).exit_code, 2);
  EXPECT_EQ(callMain({"--unknown"}, [](CommandLine& line) { line.parse(); }).exit_code, 2);
}

TEST(RunMain, MessagesGoToStderrAndNameTheProgram) {
  const Outcome outcome = callAndThrow(std::runtime_error("no such file"));
  EXPECT_EQ(outcome.err, "opp-test: no such file\n");
  EXPECT_EQ(outcome.out, "");
}

TEST(RunMain, HelpAndVersionEndWellAndGoToStdout) {
  const auto run = [](CommandLine& line) {
    line.parse();
    ADD_FAILURE() << "must not get here";
  };
  EXPECT_EQ(callMain({"--version"}, run).out, "opp-test 0.1.0\n");
  const Outcome help = callMain({"--help"}, run);
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("Tests."));
  EXPECT_EQ(help.err, "");
}

TEST(UserMessage, KeepsOnlyTheMessageOfAnMrptException) {
  EXPECT_EQ(userMessage("\n==== MRPT EXCEPTION ====\nlib.cpp, line 10:\nMessage:  File is broken \n"
                        "Callstack:\n[0] f()\n"),
            "File is broken");
  EXPECT_EQ(userMessage("plain text\n"), "plain text");
  EXPECT_EQ(userMessage(""), "");
  EXPECT_EQ(userMessage(std::runtime_error("plain text\n")), "plain text");
  EXPECT_EQ(userMessage(std::bad_alloc()), "out of memory");
}

TEST(Flags, ThreadsAreAtLeastOne) {
  int threads = -1;
  const auto run = [&](CommandLine& line) {
    const ThreadsFlag flag(line);
    line.parse();
    threads = flag.count();
  };
  EXPECT_EQ(callMain({"--threads", "3"}, run).exit_code, 0);
  EXPECT_EQ(threads, 3);
  EXPECT_EQ(callMain({}, run).exit_code, 0);
  EXPECT_EQ(threads, 0) << "all cores";
  for (const char* bad : {"0", "-2", "two", "1.5", ""}) {
    EXPECT_EQ(callMain({"--threads", bad}, run).exit_code, 2) << bad;
  }
}

TEST(Flags, ParametersComeFromDefaultsThenFileThenCommandLine) {
  const test::TempFolder folder;
  const std::string file = (folder / "a.ini").string();
  test::writeFile(file, "[sensor]\nmin_range = 1\nmax_range = 2\n");
  mapping::MapperParams params;
  const auto run = [&](CommandLine& line) {
    ParameterFlags flags(line);
    line.parse();
    flags.applyTo(params);
  };
  EXPECT_EQ(callMain({"--set", "sensor.max_range=3", "-c", file.c_str()}, run).exit_code, 0);
  EXPECT_EQ(params.primitives.sensor.noise_constant, SensorModel().noise_constant);
  EXPECT_EQ(params.primitives.sensor.min_range, 1.0);
  EXPECT_EQ(params.primitives.sensor.max_range, 3.0);

  EXPECT_EQ(callMain({"--set", "sensor.max_range=-3"}, run).exit_code, 2) << "wrong usage";
  EXPECT_EQ(callMain({"-c", "/no/such.ini"}, run).exit_code, 1) << "bad input";
}

}  // namespace
}  // namespace opp::apps
