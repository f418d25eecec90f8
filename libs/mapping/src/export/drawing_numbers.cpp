// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/drawing_numbers.h"

#include <array>
#include <charconv>
#include <cmath>

namespace opp::mapping {

std::string svgNumber(double value) {
  std::array<char, 64> buffer;
  const double rounded = std::round(10.0 * value) / 10.0 + 0.0;  // adding zero turns −0 to 0
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), rounded).ptr;
  return std::string(buffer.data(), end);
}

std::string fixedNumber(double value, int decimals) {
  const double unit = std::pow(10.0, -decimals);
  if (std::abs(value) < 0.5 * unit) value = 0.0;
  std::array<char, 400> buffer;  // the longest double has 309 digits before the point
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  return std::string(buffer.data(), end);
}

double roundStep(double wanted) {
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double digit = wanted / power >= 5.0 ? 5.0 : wanted / power >= 2.0 ? 2.0 : 1.0;
  return digit * power;
}

}  // namespace opp::mapping
