// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp-eval/statistics_report.h"

#include <iomanip>
#include <ostream>
#include <sstream>

namespace opp::mapping {
namespace {

constexpr int kNameWidth = 34;
constexpr int kCountWidth = 9;
constexpr int kValueWidth = 11;
constexpr int kDecimals = 5;  // 10 µm

}  // namespace

nlohmann::ordered_json toJson(const ErrorStatistics& statistics, double factor) {
  if (statistics.count == 0) return nullptr;
  return {{"count", statistics.count},        {"rmse", statistics.rmse * factor},
          {"mean", statistics.mean * factor}, {"median", statistics.median * factor},
          {"p90", statistics.p90 * factor},   {"max", statistics.max * factor}};
}

void printStatisticsHeading(std::ostream& out) {
  std::ostringstream row;
  row << std::setw(kNameWidth) << "" << std::setw(kCountWidth) << "count";
  for (const char* name : {"rmse", "mean", "median", "p90", "max"}) {
    row << std::setw(kValueWidth) << name;
  }
  out << row.str() << '\n';
}

void printStatistics(std::ostream& out, const std::string& name, const ErrorStatistics& statistics,
                     double factor) {
  std::ostringstream row;
  row << std::left << std::setw(kNameWidth) << name << std::right << std::setw(kCountWidth)
      << statistics.count << std::fixed << std::setprecision(kDecimals);
  for (const double value :
       {statistics.rmse, statistics.mean, statistics.median, statistics.p90, statistics.max}) {
    row << std::setw(kValueWidth);
    if (statistics.count == 0) {
      row << '-';
    } else {
      row << value * factor;
    }
  }
  out << row.str() << '\n';
}

}  // namespace opp::mapping
