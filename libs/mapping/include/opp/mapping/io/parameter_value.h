// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/params/field.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace opp::mapping {

/// Points to a member of a parameter struct; lists the types that such a member may have.
using ParameterPointer = std::variant<double*, int*, std::uint64_t*, bool*, std::string*>;

/// One parameter of a program: where it lives and what describes it.
struct Parameter {
  std::string_view section;
  Field field;
  ParameterPointer value;
};

/// Writes the value as a configuration file has it, unit included: "0.05 m", "15 deg", "true",
/// "\"text\"". Reading it with setFromText gives the same value, bit for bit; an angle that degrees
/// do not give exactly is written in radians. Independent of the locale.
/// \throws std::invalid_argument for text that holds a quote or a line end.
std::string valueText(const Parameter& parameter);

/// Reads what valueText writes. Numbers may go without unit, except angles, which need deg or rad;
/// text may go without quotes. Independent of the locale. On an error the value stays as it was.
/// \throws std::invalid_argument that says what is wrong with the text (not a number, a number of
/// another unit, not whole, out of range, ...) and what is allowed.
void setFromText(const Parameter& parameter, std::string_view text);

/// What setFromText accepts, for people: "1e-06 to 1 m", "at least 0", "true or false".
std::string rangeText(const Parameter& parameter);

}  // namespace opp::mapping
