// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/point_table.h"
#include "io/text_cursor.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace opp::mapping {
namespace {

constexpr std::size_t kColumns = 6;
constexpr std::array<const char*, kColumns> kNames = {"x", "y", "z", "nx", "ny", "nz"};

/// Whether numbers four to six of a line can be a normal written with three digits or more.
bool isUnit(double x, double y, double z) {
  constexpr double kRounding = 0.01;
  return std::abs(std::sqrt(x * x + y * y + z * z) - 1.0) < kRounding;
}

}  // namespace

PointTable readXyz(std::string_view file) {
  TextCursor cursor(file);
  PointTable table;
  bool has_normals = true;
  while (!cursor.atEnd()) {
    const std::string_view line = cursor.nextLine();
    const auto words = splitWords(line.substr(0, line.find('#')), ",;");
    if (words.empty()) continue;
    if (words.size() < 3) cursor.fail("a point needs three numbers");
    std::array<double, kColumns> values{};
    for (std::size_t k = 0; k < std::min(kColumns, words.size()); ++k) {
      if (parseNumber(words[k], values[k])) continue;
      cursor.fail("'" + std::string(words[k].substr(0, 32)) + "' is not a number");
    }
    for (std::size_t k = 0; k < kColumns; ++k) table.columns[kNames[k]].push_back(values[k]);
    has_normals = has_normals && isUnit(values[3], values[4], values[5]);
    ++table.size;
  }
  for (std::size_t k = 0; k < 3; ++k) table.columns[kNames[k]];
  for (std::size_t k = 3; k < kColumns && !has_normals; ++k) table.columns.erase(kNames[k]);
  return table;
}

}  // namespace opp::mapping
