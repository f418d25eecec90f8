// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "common/run_main.h"

#include "opp/mapping/core/version.h"
#include "opp/mapping/io/ini_file.h"

#include <malloc.h>

#include <iostream>
#include <new>
#include <stdexcept>
#include <vector>

namespace opp::apps {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

/// --version as one line, "opp-map 0.1.0"; TCLAP's own has blank lines around it.
class Output : public TCLAP::StdOutput {
 public:
  void version(TCLAP::CmdLineInterface& line) override {
    std::cout << line.getProgramName() << ' ' << line.getVersion() << '\n';
  }
};

int report(const std::string& name, std::string_view message, int exit_code) {
  std::cerr << name << ": " << message << '\n';
  if (exit_code == kWrongUsage) std::cerr << "Try " << name << " --help.\n";
  return exit_code;
}

/// Buffers of megabytes come and go with every scan. Given back to the system each time, their
/// pages are cleared each time anew, which takes up to half of a detection's time.
void keepFreedMemory() {
  constexpr int kMebibyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMebibyte);  // the largest value that glibc takes
  mallopt(M_TRIM_THRESHOLD, 256 * kMebibyte);
}

}  // namespace

std::string userMessage(std::string_view what) {
  constexpr std::string_view kMark = "Message:";
  const std::size_t mark = what.find(kMark);
  if (mark == std::string_view::npos) return std::string(mapping::trimmed(what));
  what.remove_prefix(mark + kMark.size());
  what = mapping::trimmed(what);
  return std::string(mapping::trimmed(what.substr(0, what.find('\n'))));
}

std::string userMessage(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return "out of memory";
  return userMessage(error.what());
}

int runMain(int argc, const char* const* argv, const std::string& name, const std::string& purpose,
            const std::function<void(CommandLine&)>& run) {
  keepFreedMemory();
  try {
    std::vector<std::string> arguments(argv, argv + argc);
    arguments.front() = name;  // not the path it was called by
    Output output;
    CommandLine line(purpose, std::move(arguments));
    line.setOutput(&output);
    run(line);
    if (!std::cout.flush()) throw std::runtime_error("cannot write to stdout");
    return kDone;
  } catch (const TCLAP::ExitException& exit) {  // --help, --version
    return exit.getExitStatus();
  } catch (const TCLAP::ArgException& error) {
    return report(name, error.error() + " (" + error.argId() + ")", kWrongUsage);
  } catch (const UsageError& error) {
    return report(name, error.what(), kWrongUsage);
  } catch (const std::exception& error) {
    return report(name, userMessage(error), kFailed);
  }
}

}  // namespace opp::apps
