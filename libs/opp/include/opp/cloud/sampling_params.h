// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp {

/// From raw points to an evenly spaced, oriented cloud. Lengths are not among the parameters: they
/// follow from the data's extent and the sensor's noise.
struct SamplingParams {
  static constexpr std::string_view kSection = "sampling";
  int target_samples = 8000;
  double patches_per_sample = 2.5;
  double spacing_per_sigma = 2.0;
  double normal_error = degToRad(5.0);
  int max_window_radius = 4;
  double gate = 3.0;
  double noise_floor = 0.3;
  double lateral_noise = 0.5;
  double max_incidence = degToRad(85.0);
  double merge_angle = degToRad(20.0);

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.target_samples, Field{"target_samples", "", 16, 1e6,
                              "samples that a large scan is thinned to, give or take a third"});
    f(p.patches_per_sample,
      Field{"patches_per_sample", "", 1.0, 16.0,
            "raw points are first averaged in this many patches per target sample"});
    f(p.spacing_per_sigma,
      Field{"spacing_per_sigma", "", 0.0, 100.0,
            "samples are never closer than this many standard deviations of the noise"});
    f(p.normal_error, Field{"normal_error", "rad", 1e-4, 0.5,
                            "a normal's standard deviation: windows grow until it is below"});
    f(p.max_window_radius, Field{"max_window_radius", "", 1, 16,
                                 "largest window for a normal, in patches around its own"});
    f(p.gate, Field{"gate", "", 1.0, 10.0,
                    "deviations from a local plane up to this many standard deviations are noise"});
    f(p.noise_floor,
      Field{"noise_floor", "", 0.0, 1.0,
            "a cloud may look less noisy than the sensor's model, but not below this share of it"});
    f(p.lateral_noise,
      Field{"lateral_noise", "", 0.0, 10.0,
            "error of a ray's direction in pixels: noise on slanted surfaces of a depth image"});
    f(p.max_incidence, Field{"max_incidence", "rad", 0.1, kPi / 2,
                             "surfaces seen at a flatter angle (from the normal) are dropped"});
    f(p.merge_angle, Field{"merge_angle", "rad", 0.01, kPi / 2,
                           "points are averaged only if their normals differ by less"});
  }
};

}  // namespace opp
