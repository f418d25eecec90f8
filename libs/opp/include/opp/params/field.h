// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace opp {

/// Describes one member of a parameter struct. The list that a struct's `visit` gives is the only
/// place where a parameter is described: loading, printing, validating and documenting use it.
struct Field {
  std::string_view name;  ///< key in the INI file; equals the member's name
  std::string_view
      unit;    ///< "m", "rad", "s", ...; empty: dimensionless. "rad" must carry rad/deg in files
  double min;  ///< smallest admissible value (numbers only), in `unit`
  double max;  ///< largest admissible value (numbers only), in `unit`
  std::string_view meaning;  ///< one line for people
};

/// No bound on this side of a field's range.
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Throws std::invalid_argument that names section, key, value and range of the first member of
/// `params` outside its range (NaN is outside every range).
template <typename Params>
void validate(const Params& params) {
  Params::visit(params, [](const auto& value, const Field& field) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
      const auto number = static_cast<double>(value);
      if (number >= field.min && number <= field.max) return;
      std::ostringstream message;
      message << "[" << Params::kSection << "] " << field.name << " = " << number << " "
              << field.unit << " is out of range [" << field.min << ", " << field.max << "]";
      throw std::invalid_argument(message.str());
    }
  });
}

/// validate() of every section of a composite: a struct that gathers parameter structs and has
/// `visitSections` (see opp/params/primitive_params.h).
template <typename Composite>
void validateSections(const Composite& composite) {
  Composite::visitSections(composite, [](const auto& section) { validate(section); });
}

}  // namespace opp
