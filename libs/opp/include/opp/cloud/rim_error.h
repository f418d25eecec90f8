// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

namespace opp {

/// What the patches at the rims of a strip do to the plane that is fitted to it. Such a patch takes
/// in a share x ≤ 1/2 of the strip's neighbour, which at a right angle puts it x²/2 of its extent
/// off the strip; the share extent/width of the samples lies along either rim.
struct RimError {
  double turn = 0.0;   ///< about the long axis [rad]: all patches of one rim at their worst
  double shift = 0.0;  ///< along the normal [m]: both rims, root mean square over x
};

/// Of patches of `squared_extent` [m²] on a strip whose points have `variance` across it [m²]:
/// w²/12 for a width w. Infinite where there is no width.
inline RimError rimError(double squared_extent, double variance) {
  constexpr double kWorst = 1.0 / 8.0;             // x²/2 at x = 1/2
  const double kTypical = 1.0 / std::sqrt(320.0);  // √(mean of x⁴/4 for x up to 1/2)
  if (!(variance > 0.0)) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    return {kInfinite, kInfinite};
  }
  const double width = std::sqrt(12.0 * variance);
  const double squared_ratio = squared_extent / (width * width);
  // A share p of the samples that is δ off at w/2 turns the fit by p δ (w/2) / (w²/12) and shifts
  // it by p δ; here p = extent/width, and δ is in extents.
  return {6.0 * kWorst * squared_ratio, 2.0 * kTypical * squared_ratio * width};
}

}  // namespace opp
