// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp {

/// Planes that are few pixels wide in a depth image, found pixel by pixel.
struct NarrowParams {
  static constexpr std::string_view kSection = "narrow";
  /// Half of what makes a plane count as seen: beside its edges not all pixels are told apart.
  int min_pixels = 150;
  /// Two pixels leave no degree of freedom to the noise of a ray's direction.
  double min_width = 2.5;
  /// 1.2 % of what lies on a plane is farther from it.
  double gate = 2.5;
  /// Noise cut off at the gate scatters by 0.9; a slice of a slanted surface fills the gate evenly
  /// and scatters by 2.1.
  double max_scatter = 1.3;
  double max_uncertainty = 0.1;         ///< see visit
  double max_rim_turn = degToRad(1.2);  ///< see visit

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.min_pixels, Field{"min_pixels", "", 16, 1e9, "smallest plane, in pixels"});
    f(p.min_width, Field{"min_width", "", 1.0, 1e3, "narrowest plane, in pixels"});
    f(p.gate, Field{"gate", "", 1.0, 10.0,
                    "pixels this many standard deviations of the noise off are not on a plane"});
    f(p.max_scatter, Field{"max_scatter", "", 0.1, 100.0,
                           "variance of the pixels about a plane, over that of the noise"});
    f(p.max_uncertainty, Field{"max_uncertainty", "rad", 1e-3, 1.0,
                               "a normal's standard deviation, which others may reduce"});
    f(p.max_rim_turn, Field{"max_rim_turn", "rad", 0.0, 1.0,
                            "planes that patches astride of their edges may turn by more are "
                            "looked for once more, pixel by pixel"});
  }
};

}  // namespace opp
