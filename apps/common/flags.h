// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/io/parameters.h"

#include "common/command_line.h"

#include <stdexcept>
#include <string>

// The flags that programs share; each is a TCLAP argument that attaches itself to a command line.

namespace opp::apps {

/// -i FILE, required.
struct InputFlag : TCLAP::ValueArg<std::string> {
  InputFlag(CommandLine& line, const std::string& what)
      : ValueArg("i", "input", what, true, "", "FILE", line) {}
};

/// -i FILE, at least once.
struct InputsFlag : TCLAP::MultiArg<std::string> {
  InputsFlag(CommandLine& line, const std::string& what)
      : MultiArg("i", "input", what, true, "FILE", line) {}
};

/// -o FILE or FOLDER.
struct OutputFlag : TCLAP::ValueArg<std::string> {
  OutputFlag(CommandLine& line, const std::string& what, const std::string& type, bool required)
      : ValueArg("o", "output", what, required, "", type, line) {}
};

/// --force
struct ForceFlag : TCLAP::SwitchArg {
  explicit ForceFlag(CommandLine& line)
      : SwitchArg("", "force", "Replace the results of an earlier run", line) {}
};

/// --quiet
struct QuietFlag : TCLAP::SwitchArg {
  explicit QuietFlag(CommandLine& line)
      : SwitchArg("", "quiet", "No progress and no log; only errors", line) {}
};

/// --threads N; 0, meaning all cores, unless given.
struct ThreadsFlag {
  explicit ThreadsFlag(CommandLine& line)
      : argument("", "threads",
                 "Number of threads (default: all cores); results do not depend on it", false, 0,
                 &at_least_one, line) {}
  int count() const { return argument.getValue(); }

  AtLeast at_least_one{1};
  mutable TCLAP::ValueArg<int> argument;  // mutable: getValue of TCLAP 1.2 is not const
};

/// Sets the parameter that a flag names, "section.key=value".
/// \throws UsageError that names the flag, if there is no such parameter or value.
template <typename Composite>
void setFromFlag(const std::string& assignment, const std::string& flag, Composite& params) {
  try {
    mapping::setParameter(assignment, params, flag);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

/// -c FILE.ini and --set section.key=value.
struct ParameterFlags {
  explicit ParameterFlags(CommandLine& line)
      : config("c", "config", "Parameters that differ from the defaults; opp-config lists them",
               false, "", "FILE.ini", line),
        set("", "set", "One parameter; repeatable, wins over the file", false, "section.key=value",
            line) {}

  /// Code defaults < file < --set.
  /// \throws as mapping::loadParameters for the file; UsageError for a bad --set.
  template <typename Composite>
  void applyTo(Composite& params) {
    if (config.isSet()) mapping::loadParameters(config.getValue(), params);
    for (const std::string& assignment : set.getValue()) setFromFlag(assignment, "--set", params);
  }

  TCLAP::ValueArg<std::string> config;
  TCLAP::MultiArg<std::string> set;
};

}  // namespace opp::apps
