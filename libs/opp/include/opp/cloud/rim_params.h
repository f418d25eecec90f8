// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/params/field.h"

#include <string_view>

namespace opp {

/// The search for rims in a depth image. Measured, by the rims of the next scan at the true poses:
/// their places are off by 1.4 pixels for the Xtion of TUM's fr3 sequences (1.8 for each fifth
/// scan), .3 for simulated Kinects, .15 for Redwood's synthetic camera.
struct RimParams {
  static constexpr std::string_view kSection = "rims";
  int block = 16;
  int max_gap = 32;
  int surface_pixels = 4;
  double step_sigmas = 6.0;
  double step_slopes = 3.0;
  int min_pixels = 8;
  double max_scatter = 1.0;
  double noise = 1.5;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.block, Field{"block", "", 4, 256,
                     "edge in pixels of the squares of the image in which rims are fitted"});
    f(p.max_gap, Field{"max_gap", "", 0, 256,
                       "pixels without a measurement between a surface and what is behind it"});
    f(p.surface_pixels, Field{"surface_pixels", "", 2, 32,
                              "so many pixels must be smooth for a surface to end with a rim"});
    f(p.step_sigmas,
      Field{"step_sigmas", "", 1.0, 100.0,
            "what is behind is farther by so many standard deviations of the noise"});
    f(p.step_slopes, Field{"step_slopes", "", 1.0, 100.0,
                           "and by so many times what the surface's own slope explains"});
    f(p.min_pixels, Field{"min_pixels", "", 3, 256, "rim pixels of a square: fewer are chance"});
    f(p.max_scatter,
      Field{"max_scatter", "", 0.1, 100.0,
            "scatter of a square's rim pixels about a straight line, in pixels: more is no rim"});
    f(p.noise, Field{"noise", "", 0.0, 100.0,
                     "error of a rim's place in pixels; depth cameras wash rims out"});
  }
};

}  // namespace opp
