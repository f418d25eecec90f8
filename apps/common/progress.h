// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace opp::apps {

/// Tells a person how far a long task is: a bar on a terminal, now and then a line otherwise.
/// Own class: Debian 12 has no maintained C++ library for it (`indicators` is not packaged,
/// Boost.Timer's progress_display knows no rate and no time left).
/// Not for use by several threads at once.
class Progress {
 public:
  enum class Mode { kSilent, kLines, kTerminal };
  using Clock = std::function<std::chrono::duration<double>()>;

  /// kSilent if `quiet`, else kTerminal if stderr is one, else kLines.
  static Mode modeFor(bool quiet);

  /// \param task what is done, \param unit what is counted: "mapping", "frames".
  Progress(std::string task, std::string unit, Mode mode);
  /// The same with another stream and clock, for tests.
  Progress(std::string task, std::string unit, Mode mode, std::ostream& stream, Clock clock);

  /// \param fraction of the task that is done, in [0, 1]. \param count of units done.
  /// Cheap: writes ten times a second on a terminal, otherwise every five seconds.
  void update(double fraction, std::size_t count);

  /// Writes a line for people without tearing the bar; nothing if silent.
  void log(std::string_view line);

  /// Ends the bar with a line of count, time and rate.
  void finish();

 private:
  std::string status() const;
  void clearBar();

  std::string task_;
  std::string unit_;
  Mode mode_;
  std::ostream& stream_;
  Clock clock_;
  double start_;       ///< [s]
  double last_write_;  ///< [s]
  double fraction_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace opp::apps
