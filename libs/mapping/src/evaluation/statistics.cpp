// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// Linear between the order statistics at position fraction · (n − 1).
double quantile(const std::vector<double>& sorted, double fraction) {
  const double position = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double weight = position - static_cast<double>(below);
  return (1.0 - weight) * sorted[below] + weight * sorted[above];
}

}  // namespace

ErrorStatistics statisticsOf(std::vector<double> errors) {
  ErrorStatistics result;
  if (errors.empty()) return result;
  if (!std::all_of(errors.begin(), errors.end(), [](double e) { return std::isfinite(e); })) {
    throw std::invalid_argument("statisticsOf: an error is not finite");
  }
  std::sort(errors.begin(), errors.end());
  const auto n = static_cast<double>(errors.size());
  result.count = errors.size();
  result.rmse =
      std::sqrt(std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0) / n);
  result.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / n;
  result.median = quantile(errors, 0.5);
  result.p90 = quantile(errors, 0.9);
  result.max = errors.back();
  return result;
}

}  // namespace opp::mapping
