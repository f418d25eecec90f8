// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/params/field.h"

#include <string_view>

namespace opp {

/// Corners where three orthogonal planes meet (`findCorners`). Lengths in sample spacings.
struct CornerParams {
  static constexpr std::string_view kSection = "corners";
  /// A corner may be hidden (virtual), but each plane must come this near to it.
  double radius = 5.0;
  /// A quarter disk of that radius holds π/4·radius² samples; this share of them makes it occupied.
  double min_fill = 0.1;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.radius, Field{"radius", "", 1.0, 100.0,
                      "all three planes must have samples within so many spacings of a corner"});
    f(p.min_fill, Field{"min_fill", "", 0.0, 1.0,
                        "share of the samples of a full quarter disk that makes it occupied"});
  }
};

}  // namespace opp
