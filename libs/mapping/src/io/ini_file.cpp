// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/ini_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

namespace opp::mapping {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\f\v";

bool startsComment(char c) { return c == '#' || c == ';'; }

/// The line up to a comment; marks inside quotes and directly behind text do not start one.
std::string_view withoutComment(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    const bool after_blank = i == 0 || kBlanks.find(line[i - 1]) != std::string_view::npos;
    if (!quoted && after_blank && startsComment(line[i])) return line.substr(0, i);
  }
  return line;
}

[[noreturn]] void fail(const std::string& origin, std::string_view line, std::string_view reason) {
  std::string message = origin + ": '";
  message.append(line).append("' ").append(reason);
  throw std::invalid_argument(message);
}

/// Splits "left = right"; both are trimmed. False without '=' or without a left side.
bool splitEntry(std::string_view line, std::string& left, std::string& right) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) return false;
  left = trimmed(line.substr(0, equals));
  right = trimmed(line.substr(equals + 1));
  return !left.empty();
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<IniEntry> parseIni(std::string_view text, std::string_view name) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    text.remove_prefix(kByteOrderMark.size());
  }
  std::vector<IniEntry> entries;
  std::map<std::pair<std::string, std::string>, std::string> first_origin;
  std::string section;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    const std::string_view line = trimmed(withoutComment(text.substr(0, end + 1)));
    text.remove_prefix(end + 1);
    const std::string origin = std::string(name) + ":" + std::to_string(number);
    if (line.empty()) continue;
    if (line.front() == '[') {
      section = line.back() == ']' ? trimmed(line.substr(1, line.size() - 2)) : "";
      if (section.empty()) fail(origin, line, "is not of the form [section]");
      continue;
    }
    IniEntry entry{section, "", "", origin};
    if (!splitEntry(line, entry.key, entry.value)) {
      fail(origin, line, "is neither [section] nor key = value nor a # comment");
    }
    if (section.empty()) fail(origin, line, "stands before the first [section]");
    const auto [first, is_new] = first_origin.insert({{section, entry.key}, origin});
    if (!is_new) fail(origin, line, "repeats a key of [" + section + "]; see " + first->second);
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::vector<IniEntry> readIni(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  // Opening a folder succeeds on Linux; only reading it fails.
  if (!stream || std::filesystem::is_directory(file)) {
    throw std::runtime_error("cannot read the configuration file " + file.string() +
                             "; check its path and permissions");
  }
  return parseIni(text, file.string());
}

IniEntry parseAssignment(std::string_view assignment, std::string_view origin) {
  IniEntry entry{"", "", "", std::string(origin)};
  std::string name;
  if (splitEntry(assignment, name, entry.value)) {
    const std::size_t dot = name.find('.');
    entry.section = trimmed(std::string_view(name).substr(0, dot));
    if (dot != std::string::npos) entry.key = trimmed(std::string_view(name).substr(dot + 1));
  }
  if (entry.section.empty() || entry.key.empty()) {
    fail(entry.origin, assignment, "is not of the form section.key=value");
  }
  return entry;
}

}  // namespace opp::mapping
