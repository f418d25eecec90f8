// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tclap/CmdLine.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace opp::apps {

/// The user called the program wrongly: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// TCLAP's command line, made for one program and holding the arguments it was called with. Flags
/// (flags.h, or any TCLAP argument) attach themselves to it; then parse() fills them.
class CommandLine : public TCLAP::CmdLine {
 public:
  CommandLine(const std::string& purpose, std::vector<std::string> arguments);

  /// Fills the flags. --help and --version end the program with exit code 0.
  /// \throws TCLAP::ArgException for wrong usage; runMain turns it into exit code 2.
  void parse();
  using TCLAP::CmdLine::parse;

 private:
  std::vector<std::string> arguments_;
};

/// Limits a number on the command line to at least `min`.
class AtLeast : public TCLAP::Constraint<int> {
 public:
  explicit AtLeast(int min) : min_(min) {}
  std::string description() const override { return "at least " + std::to_string(min_); }
  std::string shortID() const override { return "N"; }
  bool check(const int& value) const override { return value >= min_; }

 private:
  int min_;
};

}  // namespace opp::apps
