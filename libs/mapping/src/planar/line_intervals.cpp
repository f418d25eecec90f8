// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/line_intervals.h"

#include <algorithm>
#include <array>

namespace opp::mapping {
namespace {

using LengthByKind = std::array<double, 3>;

LineKind longestKind(const LengthByKind& lengths) {
  // kUnknown (0) wins only if nothing else was seen.
  const bool concave = lengths[static_cast<std::size_t>(LineKind::kConcave)] >
                       lengths[static_cast<std::size_t>(LineKind::kConvex)];
  const LineKind kind = concave ? LineKind::kConcave : LineKind::kConvex;
  return lengths[static_cast<std::size_t>(kind)] > 0.0 ? kind : LineKind::kUnknown;
}

}  // namespace

std::vector<LineInterval> joinedIntervals(std::vector<LineInterval> intervals, double max_gap) {
  std::sort(intervals.begin(), intervals.end(), [](const LineInterval& a, const LineInterval& b) {
    return a.begin != b.begin ? a.begin < b.begin : a.end < b.end;
  });
  std::vector<LineInterval> joined;
  LengthByKind lengths{};
  for (const LineInterval& interval : intervals) {
    if (joined.empty() || interval.begin > joined.back().end + max_gap) {
      joined.push_back(interval);
      lengths = {};
    }
    LineInterval& last = joined.back();
    last.end = std::max(last.end, interval.end);
    lengths[static_cast<std::size_t>(interval.kind)] += interval.end - interval.begin;
    last.kind = longestKind(lengths);
  }
  return joined;
}

}  // namespace opp::mapping
