// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/params/field.h"

#include <string_view>

namespace opp {

/// Lines along which two orthogonal planes meet (`findLines`). Lengths in sample spacings.
struct LineParams {
  static constexpr std::string_view kSection = "lines";
  /// Normals are smeared and samples averaged within about one spacing of an edge, so that the
  /// nearest samples with a clean normal are one to two spacings off the line.
  double reach = 3.0;
  /// Samples stand at least one spacing apart, in a band `reach` wide; a gap this long is empty.
  double max_gap = 3.0;
  double min_length = 4.0;      ///< see visit
  double min_side_share = 0.2;  ///< see visit

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.reach,
      Field{"reach", "", 1.0, 100.0, "samples support a line within so many spacings of it"});
    f(p.max_gap, Field{"max_gap", "", 1.0, 1000.0,
                       "support of a line is cut where it has a gap of so many spacings"});
    f(p.min_length, Field{"min_length", "", 0.0, 1000.0,
                          "line segments shorter than so many spacings are dropped"});
    f(p.min_side_share, Field{"min_side_share", "", 0.0, 0.5,
                              "a plane is on a side of another if this share of its samples is"});
  }
};

}  // namespace opp
