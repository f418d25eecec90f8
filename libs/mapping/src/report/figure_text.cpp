// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/figure_text.h"

#include "export/drawing_numbers.h"

#include <array>
#include <ctime>

namespace opp::mapping {

std::string metresText(double length) { return fixedNumber(length, 2) + " m"; }

std::string megabytesText(double megabytes) { return fixedNumber(megabytes, 1) + " MB"; }

std::string momentText(double unix_time) {
  constexpr double kYear5000 = 95617584000.0;
  if (!(unix_time >= 0.0 && unix_time < kYear5000)) return fixedNumber(unix_time, 3) + " s";
  const auto seconds = static_cast<std::time_t>(unix_time);
  std::tm date{};
  gmtime_r(&seconds, &date);
  std::array<char, 64> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &date)};
}

}  // namespace opp::mapping
