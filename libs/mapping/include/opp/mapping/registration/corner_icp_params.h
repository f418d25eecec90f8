// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp::mapping {

/// Parameters of the corner-assisted ICP (Sommer et al. 2020, IV-c).
struct CornerIcpParams {
  static constexpr std::string_view kSection = "corner_icp";
  double max_distance = 0.3;
  double normal_gate = degToRad(40.0);
  double kernel_width = 3.0;
  double collinear_spread = 0.2;
  int max_iterations = 60;
  double rotation_tolerance = 1e-5;
  double translation_tolerance = 1e-5;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.max_distance,
      Field{"max_distance", "m", 1e-4, 100.0, "points farther apart do not correspond"});
    f(p.normal_gate,
      Field{"normal_gate", "rad", 0.01, 1.57, "nor do points whose normals differ more"});
    f(p.kernel_width,
      Field{"kernel_width", "", 0.1, 100.0, "Cauchy kernel, in medians of the absolute residual"});
    f(p.collinear_spread,
      Field{"collinear_spread", "m", 1e-4, 10.0,
            "corners spread less (standard deviation) across a line are on it"});
    f(p.max_iterations, Field{"max_iterations", "", 1, 1000, "steps at most"});
    f(p.rotation_tolerance,
      Field{"rotation_tolerance", "rad", 1e-12, 0.1, "converged when a step rotates less"});
    f(p.translation_tolerance,
      Field{"translation_tolerance", "m", 1e-12, 0.1, "converged when a step moves less"});
  }
};

}  // namespace opp::mapping
