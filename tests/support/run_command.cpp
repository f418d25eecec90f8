// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/run_command.h"

#include "support/temp_folder.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ostream>
#include <stdexcept>
#include <thread>

namespace opp::test {
namespace {

/// Redirections of a child process. Files, not pipes: nobody has to read while the child writes.
class SpawnActions {
 public:
  SpawnActions() { posix_spawn_file_actions_init(&actions_); }
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  void open(int descriptor, const std::string& path, int flags) {
    posix_spawn_file_actions_addopen(&actions_, descriptor, path.c_str(), flags, 0600);
  }
  void changeFolder(const std::string& folder) {
    posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
  }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// Starts the command, its output going to files `out` and `err` of a folder.
pid_t start(const std::vector<std::string>& command, const TempFolder& outputs,
            const std::filesystem::path& working_folder) {
  SpawnActions actions;
  actions.open(STDIN_FILENO, "/dev/null", O_RDONLY);
  actions.open(STDOUT_FILENO, (outputs / "out").string(), O_WRONLY | O_CREAT);
  actions.open(STDERR_FILENO, (outputs / "err").string(), O_WRONLY | O_CREAT);
  if (!working_folder.empty()) actions.changeFolder(working_folder.string());

  std::vector<std::string> words = command;  // posix_spawn wants char*, not const char*
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], actions.get(), nullptr, arguments.data(), environ);
  if (error != 0) {
    throw std::runtime_error("cannot run " + command.at(0) + ": " + std::strerror(error));
  }
  return child;
}

/// Whether the child has ended, and how. \param options of waitpid
bool hasEnded(pid_t child, int options, int& status) {
  for (;;) {
    const pid_t ended = waitpid(child, &status, options);
    if (ended >= 0) return ended == child;
    if (errno != EINTR) throw std::runtime_error(std::string("waitpid: ") + std::strerror(errno));
  }
}

CommandResult resultOf(int status, const TempFolder& outputs) {
  const int exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return {exit_code, readFile(outputs / "out"), readFile(outputs / "err")};
}

}  // namespace

CommandResult runCommand(const std::vector<std::string>& command,
                         const std::filesystem::path& working_folder) {
  const TempFolder outputs;
  int status = 0;
  hasEnded(start(command, outputs, working_folder), 0, status);
  return resultOf(status, outputs);
}

CommandResult runCommandUntil(const std::function<bool()>& enough,
                              const std::vector<std::string>& command) {
  const TempFolder outputs;
  const pid_t child = start(command, outputs, {});
  int status = 0;
  while (!hasEnded(child, WNOHANG, status)) {
    if (!enough()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    kill(child, SIGKILL);
    hasEnded(child, 0, status);
    break;
  }
  return resultOf(status, outputs);
}

std::string appPath(const std::string& name) { return std::string(OPP_APPS_FOLDER "/") + name; }

CommandResult runApp(const std::string& name, std::vector<std::string> arguments,
                     const std::filesystem::path& working_folder) {
  arguments.insert(arguments.begin(), appPath(name));
  return runCommand(arguments, working_folder);
}

std::ostream& operator<<(std::ostream& os, const CommandResult& result) {
  return os << "exit code " << result.exit_code << "\n--- stdout\n"
            << result.out << "\n--- stderr\n"
            << result.err;
}

}  // namespace opp::test
