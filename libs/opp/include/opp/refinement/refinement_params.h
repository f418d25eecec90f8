// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp {

/// Joint refinement of the plane graph (`refinePlanes`). Distances are gated by the sensor's noise,
/// which the samples carry; what stands here is free of any scale.
struct RefinementParams {
  static constexpr std::string_view kSection = "refinement";
  /// Near an orthogonal edge the normals of small neighbourhoods turn through the bisector, 45° off
  /// both planes; the gate lies below that and above the noise of normals.
  double normal_gate = degToRad(25.0);
  /// Tukey's biweight: 4.685 keeps 95 % of the efficiency of least squares on Gaussian noise.
  double outlier_cutoff = 4.685;
  /// Lens and depth distortion bends large walls: the angle between two measured planes errs by
  /// this much (standard deviation) however many points they have. 0.25° is 4 mm over 1 m, what
  /// calibrated structured-light cameras show; near 0 for a simulated or ideal sensor.
  double systematic_angle = degToRad(0.25);
  /// Normals of a cylinder turn across the strip that passes for a plane; those of a plane scatter
  /// by a few degrees, but not with the place. Three standard deviations of a patch's normal.
  double max_turn = degToRad(15.0);
  /// Three standard deviations are then what a normal of a single patch may have as one.
  double max_uncertainty = degToRad(5.0 / 3.0);
  double test_sigmas = 3.0;               ///< see visit
  double max_correction = degToRad(2.5);  ///< see visit
  int min_support = 8;                    ///< see visit
  int coarse_samples = 2000;              ///< see visit
  int max_iterations = 12;                ///< see visit

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.normal_gate, Field{"normal_gate", "rad", 0.01, degToRad(45.0),
                           "a sample belongs to a plane only if their normals differ by less"});
    f(p.outlier_cutoff, Field{"outlier_cutoff", "", 2.0, 20.0,
                              "samples farther from a plane than this many sigmas are outliers"});
    f(p.systematic_angle, Field{"systematic_angle", "rad", 0.0, 0.2,
                                "error of angles between planes that more points do not reduce"});
    f(p.max_turn, Field{"max_turn", "rad", 0.01, degToRad(90.0),
                        "surfaces whose normals turn by more across their extent are curved"});
    f(p.max_uncertainty,
      Field{"max_uncertainty", "rad", 1e-3, 0.5,
            "planes whose normal is known worse (standard deviation) are dropped"});
    f(p.test_sigmas, Field{"test_sigmas", "", 1.0, 10.0,
                           "parallel and orthogonal are kept if the data deviate by fewer sigmas"});
    f(p.max_correction, Field{"max_correction", "rad", 0.0, 0.3,
                              "larger deviations are never forced, however uncertain the planes"});
    f(p.min_support,
      Field{"min_support", "", 3, 1e9, "planes with fewer samples after refinement are dropped"});
    f(p.coarse_samples,
      Field{"coarse_samples", "", 100, 1e9, "the first passes use about this many samples"});
    f(p.max_iterations,
      Field{"max_iterations", "", 1, 1000, "passes over the samples before giving up"});
  }
};

}  // namespace opp
