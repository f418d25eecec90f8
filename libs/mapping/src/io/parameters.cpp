// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/parameters.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <ostream>
#include <stdexcept>
#include <string>

namespace opp::mapping {
namespace {

[[noreturn]] void fail(const IniEntry& entry, const std::string& reason) {
  throw std::invalid_argument(entry.origin + ": [" + entry.section + "] " + entry.key + " = " +
                              entry.value + ": " + reason);
}

/// Names without repetition, for a message: "a, b, c".
std::string listed(const std::vector<std::string_view>& names) {
  std::string text;
  std::string_view last;
  for (const std::string_view name : names) {
    if (name == last) continue;
    if (!text.empty()) text += ", ";
    text += last = name;
  }
  return text;
}

[[noreturn]] void failUnknown(const IniEntry& entry, const std::vector<Parameter>& parameters) {
  std::vector<std::string_view> sections;
  std::vector<std::string_view> keys;
  for (const Parameter& parameter : parameters) {
    sections.push_back(parameter.section);
    if (parameter.section == entry.section) keys.push_back(parameter.field.name);
  }
  if (keys.empty()) fail(entry, "unknown section; there are: " + listed(sections));
  fail(entry, "unknown key; [" + entry.section + "] has: " + listed(keys));
}

/// Columns that a terminal needs for UTF-8 text: all bytes but continuations.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

constexpr std::size_t kColumns = 5;
using Row = std::array<std::string, kColumns>;

void writeRow(std::ostream& os, const Row& row, const std::array<std::size_t, kColumns>& widths) {
  std::string line = " ";
  for (std::size_t k = 0; k < kColumns; ++k) {
    line += ' ' + row[k];
    line.append(k + 1 < kColumns ? widths[k] - columns(row[k]) + 1 : 0, ' ');
  }
  os << line << '\n';
}

}  // namespace

void applyEntries(const std::vector<IniEntry>& entries, const std::vector<Parameter>& parameters) {
  for (const IniEntry& entry : entries) {
    const auto found =
        std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& parameter) {
          return parameter.section == entry.section && parameter.field.name == entry.key;
        });
    if (found == parameters.end()) failUnknown(entry, parameters);
    try {
      setFromText(*found, entry.value);
    } catch (const std::invalid_argument& error) {
      fail(entry, error.what());
    }
  }
}

void writeIni(std::ostream& os, const std::vector<Parameter>& parameters,
              const std::vector<Parameter>& defaults) {
  std::string_view section;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = parameters[i];
    if (parameter.section != section) {
      os << (section.empty() ? "[" : "\n[") << parameter.section << "]\n";
      section = parameter.section;
    }
    os << "# " << parameter.field.meaning << "; " << rangeText(parameter) << ", default "
       << valueText(defaults[i]) << '\n'
       << parameter.field.name << " = " << valueText(parameter) << '\n';
  }
}

void writeTable(std::ostream& os, const std::vector<Parameter>& parameters,
                const std::vector<Parameter>& defaults) {
  std::vector<Row> rows = {{"key", "value", "default", "allowed", "meaning"}};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = parameters[i];
    rows.push_back({std::string(parameter.field.name), valueText(parameter), valueText(defaults[i]),
                    rangeText(parameter), std::string(parameter.field.meaning)});
  }
  std::array<std::size_t, kColumns> widths{};
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < kColumns; ++k) widths[k] = std::max(widths[k], columns(row[k]));
  }
  writeRow(os, rows.front(), widths);
  std::string_view section;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].section != section) os << '[' << (section = parameters[i].section) << "]\n";
    writeRow(os, rows[i + 1], widths);
  }
}

}  // namespace opp::mapping
