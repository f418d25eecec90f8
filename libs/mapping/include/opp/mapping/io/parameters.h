// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/io/ini_file.h"
#include "opp/mapping/io/parameter_value.h"

#include <filesystem>
#include <iosfwd>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

// One INI format for all parameters. A section is a struct with `kSection` and `visit` (one per
// stage, see opp/cloud/sensor_model.h); a composite gathers sections and has
//
//     template <typename Self, typename F>
//     static void visitSections(Self&& p, F&& f) { f(p.sensor); f(p.voting); ... }

namespace opp::mapping {

/// Every parameter of a composite, in its order; they point into `composite`.
template <typename Composite>
std::vector<Parameter> parametersOf(Composite& composite) {
  std::vector<Parameter> list;
  Composite::visitSections(composite, [&list](auto& section) {
    using Section = std::decay_t<decltype(section)>;
    Section::visit(section, [&list](auto& value, const Field& field) {
      list.push_back({Section::kSection, field, &value});
    });
  });
  return list;
}

/// Sets the parameters that the entries name.
/// \throws std::invalid_argument that names origin, section, key, value and what is allowed, for a
/// section or key that no parameter has and for a value that setFromText refuses. Parameters of
/// earlier entries are set by then.
void applyEntries(const std::vector<IniEntry>& entries, const std::vector<Parameter>& parameters);

/// Writes an INI text that sets every parameter, with meaning, range and default above each.
/// \param defaults the same list for the code's defaults.
void writeIni(std::ostream& os, const std::vector<Parameter>& parameters,
              const std::vector<Parameter>& defaults);

/// Writes a table for people: value, default, range and meaning of each parameter, by section.
void writeTable(std::ostream& os, const std::vector<Parameter>& parameters,
                const std::vector<Parameter>& defaults);

/// Sets what the file names; the rest stays. On an error nothing changes.
/// \throws std::runtime_error if the file cannot be read; std::invalid_argument as parseIni and
/// applyEntries.
template <typename Composite>
void loadParameters(const std::filesystem::path& file, Composite& composite) {
  Composite changed = composite;
  applyEntries(readIni(file), parametersOf(changed));
  composite = std::move(changed);
}

/// Sets one parameter from "section.key=value". On an error nothing changes.
/// \param origin for messages. \throws std::invalid_argument as parseAssignment and applyEntries.
template <typename Composite>
void setParameter(std::string_view assignment, Composite& composite,
                  std::string_view origin = "--set") {
  applyEntries({parseAssignment(assignment, origin)}, parametersOf(composite));
}

/// Writes an INI text that loadParameters reads back to the same values.
template <typename Composite>
void writeParameters(std::ostream& os, Composite composite) {
  Composite defaults;
  writeIni(os, parametersOf(composite), parametersOf(defaults));
}

/// Writes a table for people.
template <typename Composite>
void writeParameterTable(std::ostream& os, Composite composite) {
  Composite defaults;
  writeTable(os, parametersOf(composite), parametersOf(defaults));
}

}  // namespace opp::mapping
