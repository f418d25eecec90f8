// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace opp::mapping {

/// Summary of a set of errors, in their own unit.
struct ErrorStatistics {
  std::size_t count = 0;  ///< 0: there was nothing to measure, and all other members are 0
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  ///< mean of the two middle values where `count` is even
  double p90 = 0.0;     ///< 90th percentile, linear between the two nearest values
  double max = 0.0;
};

/// Statistics of `errors` (any order). O(n log n).
/// \throws std::invalid_argument if a value is not finite.
ErrorStatistics statisticsOf(std::vector<double> errors);

}  // namespace opp::mapping
