// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/parameter_value.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/io/ini_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <system_error>
#include <type_traits>

namespace opp::mapping {
namespace {

bool isAngle(const Field& field) { return field.unit == "rad"; }

/// Shortest text that reads back as the same number.
template <typename Number>
std::string shortest(Number number) {
  std::array<char, 32> buffer{};  // the longest double takes 24 characters
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  return {buffer.data(), end};
}

/// At most six significant digits, enough for a bound or a rounded angle.
std::string rounded(double number) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number,
                                 std::chars_format::general, 6)
                       .ptr;
  return {buffer.data(), end};
}

std::string withUnit(std::string number, std::string_view unit) {
  if (!unit.empty()) number.append(" ").append(unit);
  return number;
}

/// Whether at most six digits in degrees give exactly this angle.
bool isRoundInDegrees(double radians) {
  const std::string degrees = rounded(radToDeg(radians));
  double parsed = 0.0;
  std::from_chars(degrees.data(), degrees.data() + degrees.size(), parsed);
  return degToRad(parsed) == radians;
}

std::string angleText(double radians) {
  return isRoundInDegrees(radians) ? rounded(radToDeg(radians)) + " deg"
                                   : shortest(radians) + " rad";
}

std::string quoted(const std::string& text) {
  if (text.find_first_of("\"\r\n") != std::string::npos) {
    throw std::invalid_argument("text with a quote or a line end cannot be written: " + text);
  }
  return '"' + text + '"';
}

[[noreturn]] void fail(const Parameter& parameter, std::string_view reason) {
  throw std::invalid_argument(std::string(reason) + "; allowed: " + rangeText(parameter));
}

/// Throws unless `unit` may stand behind a number of this parameter.
void checkUnit(const Parameter& parameter, std::string_view unit) {
  const std::string_view own = parameter.field.unit;
  const std::string found = "'" + std::string(unit) + "'";
  if (isAngle(parameter.field)) {
    if (unit.empty()) fail(parameter, "an angle needs its unit, deg or rad");
    if (unit != "rad" && unit != "deg") fail(parameter, found + " is not the unit deg or rad");
  } else if (!unit.empty() && unit != own) {
    fail(parameter, own.empty() ? found + " follows a number without unit"
                                : found + " is not the unit " + std::string(own));
  }
}

/// The leading number of the text, and what follows it.
template <typename Number>
Number parseNumber(const Parameter& parameter, std::string_view text, std::string_view& unit) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc::invalid_argument) {
    fail(parameter, std::is_integral_v<Number> ? "not a whole number" : "not a number");
  }
  if (error == std::errc::result_out_of_range) fail(parameter, "out of range");
  unit = trimmed({next, static_cast<std::size_t>(end - next)});
  return number;
}

void checkRange(const Parameter& parameter, double number) {
  if (!std::isfinite(number)) fail(parameter, "not a finite number");
  if (!(number >= parameter.field.min && number <= parameter.field.max)) {
    fail(parameter, "out of range");
  }
}

void set(const Parameter& parameter, std::string_view text, double& value) {
  std::string_view unit;
  const double number = parseNumber<double>(parameter, text, unit);
  checkUnit(parameter, unit);
  const double result = isAngle(parameter.field) && unit == "deg" ? degToRad(number) : number;
  checkRange(parameter, result);
  value = result;
}

template <typename Integer>
std::enable_if_t<std::is_integral_v<Integer>> set(const Parameter& parameter, std::string_view text,
                                                  Integer& value) {
  std::string_view unit;
  const auto number = parseNumber<Integer>(parameter, text, unit);
  if (!unit.empty() && (unit.front() == '.' || unit.front() == 'e' || unit.front() == 'E')) {
    fail(parameter, "not a whole number");
  }
  checkUnit(parameter, unit);
  checkRange(parameter, static_cast<double>(number));
  value = number;
}

void set(const Parameter& parameter, std::string_view text, bool& value) {
  if (text != "true" && text != "false") fail(parameter, "not a truth value");
  value = text == "true";
}

void set(const Parameter& parameter, std::string_view text, std::string& value) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    text = text.substr(1, text.size() - 2);
  }
  if (text.find('"') != std::string_view::npos) fail(parameter, "a quote inside text");
  value = text;
}

}  // namespace

std::string valueText(const Parameter& parameter) {
  return std::visit(
      [&](const auto* value) -> std::string {
        using Value = std::decay_t<decltype(*value)>;
        if constexpr (std::is_same_v<Value, std::string>) {
          return quoted(*value);
        } else if constexpr (std::is_same_v<Value, bool>) {
          return *value ? "true" : "false";
        } else if (std::is_same_v<Value, double> && isAngle(parameter.field)) {
          return angleText(static_cast<double>(*value));
        } else {
          return withUnit(shortest(*value), parameter.field.unit);
        }
      },
      parameter.value);
}

void setFromText(const Parameter& parameter, std::string_view text) {
  std::visit([&](auto* value) { set(parameter, trimmed(text), *value); }, parameter.value);
}

std::string rangeText(const Parameter& parameter) {
  if (std::holds_alternative<bool*>(parameter.value)) return "true or false";
  if (std::holds_alternative<std::string*>(parameter.value)) return "text";
  const Field& field = parameter.field;
  std::string_view unit = field.unit;
  double scale = 1.0;
  if (isAngle(field) && isRoundInDegrees(field.min) && isRoundInDegrees(field.max)) {
    unit = "deg";
    scale = radToDeg(1.0);
  }
  const std::string min = rounded(scale * field.min);
  const std::string max = rounded(scale * field.max);
  if (std::isinf(field.min) && std::isinf(field.max)) return withUnit("any number", unit);
  if (std::isinf(field.max)) return withUnit("at least " + min, unit);
  if (std::isinf(field.min)) return withUnit("at most " + max, unit);
  return withUnit(min + " to " + max, unit);
}

}  // namespace opp::mapping
