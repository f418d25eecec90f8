// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// One `key = value` line.
struct IniEntry {
  std::string section;
  std::string key;
  std::string value;   ///< without comment and surrounding blanks; quoted text keeps its quotes
  std::string origin;  ///< for messages: "file.ini:12", or where else the value was given
};

/// Splits INI text into its entries, in their order:
///
///     # comment             ; comment
///     [section]
///     key = value           # a comment after a value needs a blank before it
///     text = "may hold # and ; and surrounding blanks"
///
/// Sections and keys are case-sensitive; a section may be opened again; a key may occur once only.
/// Windows line ends and a UTF-8 byte order mark are accepted.
///
/// Own parser, because none of Debian's tells the line a value stands in and refuses what it does
/// not understand: MRPT's CConfigFile turns bad numbers into 0 and a missing file into defaults,
/// inih cuts long names and lines silently and joins indented lines to the value before,
/// SimpleIni and iniparser let the last duplicate win.
/// \param name of the text, for messages.
/// \throws std::invalid_argument that names `name`, line and text of the first line that is no
/// section, entry or comment, of a key before the first section, or of a key given twice.
std::vector<IniEntry> parseIni(std::string_view text, std::string_view name);

/// parseIni of a file. \throws std::runtime_error if the file cannot be read.
std::vector<IniEntry> readIni(const std::filesystem::path& file);

/// Splits "section.key=value" (blanks around the parts are allowed).
/// \param origin for messages, e.g. "--set".
/// \throws std::invalid_argument if it has another form.
IniEntry parseAssignment(std::string_view assignment, std::string_view origin);

/// Text without blanks (space, tab, line ends) at both ends.
std::string_view trimmed(std::string_view text);

}  // namespace opp::mapping
