// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// A length over time as an SVG element for a page of HTML, whose style gives colours to its
/// classes: `line`, `gap` (a band over the times without a value), `grid`, `name`.
/// \param name markup, written as it is. \param times [s], finite and ascending. \param values [m],
/// one a time; NaN where there is none: the line is interrupted. Many values cost no more room than
/// the picture can show. No times at all: an empty picture.
/// \throws std::invalid_argument if times and values differ in number.
std::string timePlotSvg(std::string_view name, const std::vector<double>& times,
                        const std::vector<double>& values);

}  // namespace opp::mapping
