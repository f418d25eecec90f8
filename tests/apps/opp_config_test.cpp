// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/io/parameters.h"

#include "support/random.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace opp::test {
namespace {

using testing::HasSubstr;

const std::string kConfigFolder = OPP_SOURCE_FOLDER "/config/";

TEST(OppConfig, PrintsEveryParameterOnStdout) {
  const CommandResult result = runApp("opp-config", {});
  EXPECT_EQ(result.exit_code, 0) << result;
  EXPECT_EQ(result.err, "");
  mapping::MapperParams params;
  for (const mapping::Parameter& parameter : mapping::parametersOf(params)) {
    EXPECT_THAT(result.out, HasSubstr("  " + std::string(parameter.field.name) + " "));
    EXPECT_THAT(result.out, HasSubstr(std::string(parameter.field.meaning)));
  }
}

TEST(OppConfig, DefaultIniEqualsTheCode) {
  const TempFolder folder;
  const CommandResult result = runApp("opp-config", {"--write", (folder / "now.ini").string()});
  ASSERT_EQ(result.exit_code, 0) << result;
  EXPECT_EQ(readFile(kConfigFolder + "default.ini"), readFile(folder / "now.ini"))
      << "A default changed. In the repository's folder run\n  " << appPath("opp-config")
      << " --write config/default.ini";
}

TEST(OppConfig, WrittenFileGivesTheSameParametersAgain) {
  const TempFolder folder;
  const std::string first = (folder / "first.ini").string();
  const std::string second = (folder / "second.ini").string();
  ASSERT_EQ(runApp("opp-config", {"-c", kConfigFolder + "lidar.ini", "--set",
                                  "sensor.max_range=77.7 m", "--write", first})
                .exit_code,
            0);
  EXPECT_THAT(readFile(first), HasSubstr("max_range = 77.7 m\n"));
  EXPECT_THAT(readFile(first), HasSubstr("noise_constant = 0.02 m\n"));
  ASSERT_EQ(runApp("opp-config", {"-c", first, "--write", second}).exit_code, 0);
  EXPECT_EQ(readFile(first), readFile(second));
}

TEST(ConfigFiles, HoldOnlyWhatDiffersFromTheDefaults) {
  for (const char* name : {"rgbd.ini", "lidar.ini"}) {
    const std::vector<mapping::IniEntry> entries = mapping::readIni(kConfigFolder + name);
    mapping::MapperParams params;
    const mapping::MapperParams defaults;
    mapping::loadParameters(kConfigFolder + name, params);
    EXPECT_NO_THROW(validateSections(params));
    std::size_t different = 0;
    mapping::MapperParams copy = defaults;
    const auto changed = mapping::parametersOf(params);
    const auto original = mapping::parametersOf(copy);
    for (std::size_t i = 0; i < changed.size(); ++i) {
      if (mapping::valueText(changed[i]) != mapping::valueText(original[i])) ++different;
    }
    EXPECT_EQ(different, entries.size()) << name;
  }
}

TEST(OppConfig, WrongUsageIsExitCode2AndWritesNothing) {
  const TempFolder folder;
  const std::string file = (folder / "out.ini").string();
  const std::vector<std::vector<std::string>> calls = {
      {"--bogus"},
      {"stray"},
      {"--write"},
      {"--write", file, "--set", "sensor.max_range"},
      {"--write", file, "--set", "sensor.max_rnge=1"},
      {"--write", file, "--set", "sensor.max_range=abc"},
      {"--write", file, "--set", "sensor.max_range=-1"},
      {"--write", file, "--set", "snsor.max_range=1"}};
  for (const auto& call : calls) {
    const CommandResult result = runApp("opp-config", call);
    EXPECT_EQ(result.exit_code, 2) << result;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, testing::StartsWith("opp-config: ")) << testing::PrintToString(call);
  }
  EXPECT_TRUE(folder.contents().empty());
}

TEST(OppConfig, BadFileIsExitCode1NamesTheFileAndWritesNothing) {
  const TempFolder folder;
  const std::string output = (folder / "out.ini").string();
  const std::string bad = (folder / "bad.ini").string();
  Random random(1);
  std::string noise;
  for (int i = 0; i < 1000; ++i) noise += static_cast<char>(random.integer(-128, 127));
  for (const std::string& bytes :
       {noise, std::string("[sensor]\nmax_range = 3.7.1\n"), std::string("max_range = 3")}) {
    writeFile(bad, bytes);
    const CommandResult result = runApp("opp-config", {"-c", bad, "--write", output});
    EXPECT_EQ(result.exit_code, 1) << result;
    EXPECT_THAT(result.err, HasSubstr(bad + ":"));
  }
  EXPECT_EQ(
      runApp("opp-config", {"-c", (folder / "missing").string(), "--write", output}).exit_code, 1);
  EXPECT_EQ(runApp("opp-config", {"-c", folder.path().string()}).exit_code, 1);
  EXPECT_EQ(runApp("opp-config", {"--write", (folder / "no/such/folder.ini").string()}).exit_code,
            1);
  EXPECT_EQ(folder.contents(), std::vector<std::string>{"bad.ini"});
}

TEST(OppConfig, EmptyFileChangesNothing) {
  const TempFolder folder;
  writeFile(folder / "empty.ini", "");
  EXPECT_EQ(runApp("opp-config", {"-c", (folder / "empty.ini").string()}).out,
            runApp("opp-config", {}).out);
}

TEST(OppConfig, DoesNotDependOnTheLocale) {
  const CommandResult result = runCommand(
      {"env", "LC_ALL=de_DE.UTF-8", appPath("opp-config"), "--set", "sensor.max_range=2.5"});
  EXPECT_EQ(result.exit_code, 0) << result;
  EXPECT_THAT(result.out, HasSubstr("2.5 m"));
}

TEST(OppConfig, FullOutputIsAnError) {
  const CommandResult result = runCommand({"sh", "-c", appPath("opp-config") + " > /dev/full"});
  EXPECT_EQ(result.exit_code, 1) << result;
}

}  // namespace
}  // namespace opp::test
