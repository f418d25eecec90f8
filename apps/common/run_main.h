// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/command_line.h"

#include <exception>
#include <functional>
#include <string>
#include <string_view>

namespace opp::apps {

/// The body of every main(): runs the program and turns what it throws into a message on stderr and
/// the exit code of the contract: 0 done (also --help, --version), 1 input or processing error,
/// 2 wrong usage (UsageError, TCLAP's errors).
/// \param name the program's, e.g. "opp-map". \param purpose one sentence for --help.
/// \param run declares its flags on the command line, calls parse() on it, and works.
int runMain(int argc, const char* const* argv, const std::string& name, const std::string& purpose,
            const std::function<void(CommandLine&)>& run);

/// The part of an exception's text that a user wants: MRPT's exceptions carry a backtrace, of which
/// only the text behind "Message:" is kept; other texts stay as they are.
std::string userMessage(std::string_view what);
/// The same for the exception itself; also tells of lack of memory.
std::string userMessage(const std::exception& error);

}  // namespace opp::apps
