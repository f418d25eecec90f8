// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp::mapping {

/// Parameters of the joint optimization of keyframe poses and plane landmarks.
struct BackendParams {
  static constexpr std::string_view kSection = "backend";
  int window = 10;
  int max_iterations = 30;
  double kernel_width = 3.0;
  double orthogonality_sigma = degToRad(0.1);

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.window,
      Field{"window", "", 1, 1e6, "newest keyframes whose poses a local optimization may move"});
    f(p.max_iterations, Field{"max_iterations", "", 1, 1000, "solver steps at most"});
    f(p.kernel_width, Field{"kernel_width", "", 0.1, 100.0,
                            "Cauchy kernel of a (keyframe, plane) pair, in sigmas per sample"});
    f(p.orthogonality_sigma, Field{"orthogonality_sigma", "rad", 1e-6, 1.0,
                                   "uncertainty of a right angle that the scans support"});
  }
};

}  // namespace opp::mapping
