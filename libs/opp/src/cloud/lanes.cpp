// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/lanes.h"

namespace opp {

Lanes whereGreater(const Lanes& a, const Lanes& b, const Lanes& x, const Lanes& y) {
  Lanes result;
  for (int k = 0; k < kLanes; ++k) {
    const double greater = x[k], other = y[k];  // both are read, whichever is taken
    result[k] = a[k] > b[k] ? greater : other;
  }
  return result;
}

}  // namespace opp
