// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/text_cursor.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <system_error>

namespace opp::mapping {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

bool isBlank(char c) { return kBlanks.find(c) != std::string_view::npos; }

template <typename Number>
bool parseWhole(std::string_view word, Number& number) {
  const char* const end = word.data() + word.size();
  const auto [next, error] = std::from_chars(word.data(), end, number);
  return error == std::errc{} && next == end;
}

}  // namespace

std::string_view TextCursor::nextLine() {
  last_line_ = line_;
  if (atEnd()) return {};
  const std::size_t end = std::min(text_.find('\n', position_), text_.size());
  std::string_view line = text_.substr(position_, end - position_);
  position_ = std::min(end + 1, text_.size());
  if (end < text_.size()) ++line_;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

double TextCursor::nextNumber() {
  while (!atEnd() && (isBlank(text_[position_]) || text_[position_] == '\n')) {
    if (text_[position_] == '\n') ++line_;
    ++position_;
  }
  last_line_ = line_;
  if (atEnd()) fail("the file ends before all of its points; it is truncated");
  const std::size_t start = position_;
  while (!atEnd() && !isBlank(text_[position_]) && text_[position_] != '\n') ++position_;
  const std::string_view word = text_.substr(start, position_ - start);
  double number = 0.0;
  if (!parseNumber(word, number)) fail("'" + std::string(word.substr(0, 32)) + "' is not a number");
  return number;
}

void TextCursor::fail(const std::string& what) const {
  throw std::runtime_error("line " + std::to_string(last_line_) + ": " + what);
}

std::vector<std::string_view> splitWords(std::string_view line, std::string_view separators) {
  std::vector<std::string_view> words;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    const bool gap =
        i == line.size() || isBlank(line[i]) || separators.find(line[i]) != std::string_view::npos;
    if (!gap) continue;
    if (i > start) words.push_back(line.substr(start, i - start));
    start = i + 1;
  }
  return words;
}

bool parseNumber(std::string_view word, double& number) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  return parseWhole(word, number);
}

bool parseCount(std::string_view word, std::uint64_t& count) { return parseWhole(word, count); }

}  // namespace opp::mapping
