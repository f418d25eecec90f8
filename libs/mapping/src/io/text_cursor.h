// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// Reads a text from front to back and knows the line it is in.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : text_(text) {}

  bool atEnd() const { return position_ >= text_.size(); }
  std::size_t position() const { return position_; }  ///< in bytes from the start
  std::size_t lineNumber() const { return line_; }    ///< from 1

  /// The next line without its end (LF or CR LF). Empty at the end of the text.
  std::string_view nextLine();

  /// The next number, wherever lines end. \throws std::runtime_error if there is none.
  double nextNumber();

  /// Throws std::runtime_error "line N: what", N being the line that was read last.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t line_ = 1;
  std::size_t last_line_ = 1;
};

/// The parts of a line between blanks and any of `separators`.
std::vector<std::string_view> splitWords(std::string_view line, std::string_view separators = "");

/// Reads a whole word as a number ("nan" and "inf" included); false if it is none.
bool parseNumber(std::string_view word, double& number);
bool parseCount(std::string_view word, std::uint64_t& count);

}  // namespace opp::mapping
