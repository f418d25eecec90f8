// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "common/command_line.h"

#include "opp/mapping/core/version.h"

#include <utility>

namespace opp::apps {

CommandLine::CommandLine(const std::string& purpose, std::vector<std::string> arguments)
    : TCLAP::CmdLine(purpose, ' ', std::string(mapping::version())),
      arguments_(std::move(arguments)) {
  setExceptionHandling(false);  // TCLAP would exit with code 1
}

void CommandLine::parse() {
  std::vector<std::string> arguments = arguments_;  // TCLAP takes the first element away
  TCLAP::CmdLine::parse(arguments);
}

}  // namespace opp::apps
