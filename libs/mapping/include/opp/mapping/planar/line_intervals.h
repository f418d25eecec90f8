// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/primitives/primitives.h"

#include <vector>

namespace opp::mapping {

/// A stretch of a line, in metres along it, and how it was seen to bend there.
struct LineInterval {
  double begin = 0.0;
  double end = 0.0;
  LineKind kind = LineKind::kUnknown;
};

/// Union of intervals, ascending; gaps up to `max_gap` [m] are closed. The kind of a joined
/// interval is the one that most of its length was seen as. O(n log n).
std::vector<LineInterval> joinedIntervals(std::vector<LineInterval> intervals, double max_gap);

}  // namespace opp::mapping
