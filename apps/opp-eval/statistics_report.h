// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/mapping/evaluation/statistics.h"

#include <nlohmann/json.hpp>

#include <iosfwd>
#include <string>

namespace opp::mapping {

inline constexpr double kDegreesPerRadian = radToDeg(1.0);

/// {"count", "rmse", "mean", "median", "p90", "max"}, values times `factor`; null where there was
/// nothing to measure.
nlohmann::ordered_json toJson(const ErrorStatistics& statistics, double factor = 1.0);

/// Heading of the rows that printStatistics writes.
void printStatisticsHeading(std::ostream& out);

/// One row: name, count and values times `factor`; dashes where there was nothing to measure.
void printStatistics(std::ostream& out, const std::string& name, const ErrorStatistics& statistics,
                     double factor = 1.0);

}  // namespace opp::mapping
