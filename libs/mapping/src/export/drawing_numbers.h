// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace opp::mapping {

/// A coordinate of an SVG drawing, to tenths of its unit: "12.3", "-4", "0".
std::string svgNumber(double value);

/// A decimal number with so many digits after the point, never "-0".
std::string fixedNumber(double value, int decimals);

/// The largest of 1, 2 or 5 times a power of ten that is not above `wanted`, which must be > 0:
/// what scale bars and the ticks of an axis are made of.
double roundStep(double wanted);

}  // namespace opp::mapping
