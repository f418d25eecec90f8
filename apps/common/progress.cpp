// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "common/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <utility>

namespace opp::apps {
namespace {

constexpr double kBarInterval = 0.1;   ///< [s]
constexpr double kLineInterval = 5.0;  ///< [s]
constexpr int kBarWidth = 24;
constexpr std::string_view kClearLine = "\r\x1b[K";

std::chrono::duration<double> steadyNow() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// "0:42", "1:02:05"
std::string clockText(double seconds) {
  const auto total = static_cast<long>(std::ceil(seconds));
  std::ostringstream os;
  if (total >= 3600) os << total / 3600 << ':' << std::setw(2) << std::setfill('0');
  os << total / 60 % 60 << ':' << std::setw(2) << std::setfill('0') << total % 60;
  return os.str();
}

}  // namespace

Progress::Mode Progress::modeFor(bool quiet) {
  if (quiet) return Mode::kSilent;
  return isatty(STDERR_FILENO) != 0 ? Mode::kTerminal : Mode::kLines;
}

Progress::Progress(std::string task, std::string unit, Mode mode)
    : Progress(std::move(task), std::move(unit), mode, std::cerr, steadyNow) {}

Progress::Progress(std::string task, std::string unit, Mode mode, std::ostream& stream, Clock clock)
    : task_(std::move(task)),
      unit_(std::move(unit)),
      mode_(mode),
      stream_(stream),
      clock_(std::move(clock)),
      start_(clock_().count()),
      last_write_(start_) {}

std::string Progress::status() const {
  const double elapsed = clock_().count() - start_;
  std::ostringstream os;
  os << std::fixed << std::setprecision(0) << std::setw(3) << 100.0 * fraction_ << " %, " << count_
     << ' ' << unit_;
  if (elapsed > 0.0) {
    os << ", " << std::setprecision(1) << static_cast<double>(count_) / elapsed << ' ' << unit_
       << "/s";
  }
  if (fraction_ > 0.0) os << ", " << clockText(elapsed * (1.0 - fraction_) / fraction_) << " left";
  return os.str();
}

void Progress::update(double fraction, std::size_t count) {
  fraction_ = fraction >= 0.0 ? std::min(fraction, 1.0) : 0.0;  // NaN: 0
  count_ = count;
  if (mode_ == Mode::kSilent) return;
  const double now = clock_().count();
  if (now - last_write_ < (mode_ == Mode::kTerminal ? kBarInterval : kLineInterval)) return;
  last_write_ = now;
  if (mode_ == Mode::kLines) {
    stream_ << task_ << ": " << status() << std::endl;
    return;
  }
  const auto filled = static_cast<std::size_t>(std::lround(fraction_ * kBarWidth));
  stream_ << kClearLine << task_ << " [" << std::string(filled, '#')
          << std::string(kBarWidth - filled, '.') << "] " << status() << std::flush;
}

void Progress::clearBar() {
  if (mode_ == Mode::kTerminal) stream_ << kClearLine;
}

void Progress::log(std::string_view line) {
  if (mode_ == Mode::kSilent) return;
  clearBar();
  stream_ << line << std::endl;
}

void Progress::finish() {
  if (mode_ == Mode::kSilent) return;
  const double elapsed = clock_().count() - start_;
  std::ostringstream os;
  os << task_ << ": " << count_ << ' ' << unit_ << " in " << std::fixed << std::setprecision(1)
     << elapsed << " s";
  if (elapsed > 0.0) os << ", " << static_cast<double>(count_) / elapsed << ' ' << unit_ << "/s";
  log(os.str());
}

}  // namespace opp::apps
