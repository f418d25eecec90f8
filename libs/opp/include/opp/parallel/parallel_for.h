// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace opp {

/// Calls `body(i)` once for each i in [0, count), on up to `threads` threads (≤ 0: all cores; 1:
/// the caller's). Which thread runs which i is not fixed: a body that writes only to slot i gives
/// the same result for every thread count. The first exception (of the smallest i that threw) is
/// rethrown after all threads have ended.
void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

/// `threads` if positive, else the number of cores (at least 1).
int resolveThreads(int threads);

}  // namespace opp
