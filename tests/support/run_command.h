// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace opp::test {

/// What a program that has ended left behind.
struct CommandResult {
  int exit_code = 0;  ///< 128 + signal number if a signal ended it, as in a shell
  std::string out;    ///< all of its stdout
  std::string err;    ///< all of its stderr
};

/// For GoogleTest's messages.
std::ostream& operator<<(std::ostream& os, const CommandResult& result);

/// Runs `command[0]` (searched in PATH if it has no slash) with the remaining elements as
/// arguments, passed as they are (no shell, no quoting), with empty stdin, and waits for its end.
/// \param working_folder where it runs; empty: the caller's.
/// \throws std::runtime_error if the program cannot be started.
CommandResult runCommand(const std::vector<std::string>& command,
                         const std::filesystem::path& working_folder = {});

/// The same for a program that is killed as soon as `enough` is true, unless it ends before; exit
/// code 128 + SIGKILL then. \param enough is asked every millisecond.
CommandResult runCommandUntil(const std::function<bool()>& enough,
                              const std::vector<std::string>& command);

/// Path of a program of this build, e.g. appPath("opp-map"). The test's CMake target must be made
/// by opp_add_app_tests, which builds the programs first.
std::string appPath(const std::string& name);

/// runCommand with a program of this build: runApp("opp-map", {"-i", file}).
CommandResult runApp(const std::string& name, std::vector<std::string> arguments,
                     const std::filesystem::path& working_folder = {});

}  // namespace opp::test
