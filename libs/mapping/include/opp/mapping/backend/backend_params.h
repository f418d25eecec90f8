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
  /// Right angles and parallelism are tested in single scans, whose planes err by this much
  /// together however many points they have (RefinementParams::systematic_angle).
  double orthogonality_sigma = degToRad(0.25);
  double parallelism_sigma = degToRad(0.25);
  bool angles = true;
  /// Wide: a loop may have to pull the map by many of its own sigmas, which are millimetres.
  double loop_kernel_width = 100.0;
  /// Surfaces of rooms seldom lie in parallel planes that are nearer: at 3 sigmas, one in 40 pairs
  /// of heights within 60 cm does so by chance.
  double coplanar_resolution = 0.0025;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.window,
      Field{"window", "", 1, 1e6, "newest keyframes whose poses a local optimization may move"});
    f(p.max_iterations, Field{"max_iterations", "", 1, 1000, "solver steps at most"});
    f(p.kernel_width, Field{"kernel_width", "", 0.1, 100.0,
                            "Cauchy kernel of a (keyframe, plane) pair, in sigmas per sample"});
    f(p.orthogonality_sigma, Field{"orthogonality_sigma", "rad", 1e-6, 1.0,
                                   "uncertainty of a right angle that the scans support"});
    f(p.parallelism_sigma, Field{"parallelism_sigma", "rad", 1e-6, 1.0,
                                 "uncertainty of parallel planes that the scans support"});
    f(p.angles, Field{"angles", "", 0, 1, "use right angles and parallel planes at all"});
    f(p.loop_kernel_width,
      Field{"loop_kernel_width", "", 0.1, 1e6, "Cauchy kernel of a loop closure, in sigmas"});
    f(p.coplanar_resolution,
      Field{"coplanar_resolution", "m", 0.0, 0.1,
            "planes of the finished map that agree, and of which each tells so well (standard "
            "deviation) where it passes at the other's place, are one"});
  }
};

}  // namespace opp::mapping
