// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp {

/// Local Hough voting (`detectOpps`). Lengths are multiples of the sample spacing or of the noise,
/// so that a desk and a hall need the same values. Sommer et al. 2020, V-c: 500–2000 reference
/// points, 250 partners within 1 m, δ_n = 20°, bins of 10° and 8 cm.
struct VotingParams {
  static constexpr std::string_view kSection = "voting";
  int reference_points = 250;         ///< N
  int narrow_reference_points = 250;  ///< see visit
  int round_size = 50;                ///< see visit
  int partners = 300;                 ///< K
  double neighbourhood = 22.0;        ///< τ_d / spacing
  double narrowing = 3.0;             ///< see visit
  /// A square of 8 × 8 samples has nearly half of them at its rim.
  int detail_samples = 64;
  double normal_tolerance = degToRad(20.0);  ///< δ_n
  int theta_bins = 18;                       ///< see visit
  int rho_bins = 25;                         ///< see visit
  double false_alarms = 1e-3;                ///< see visit
  double noise_gate = 3.0;                   ///< see visit
  double flatness = 0.1;                     ///< see visit
  int seed = 1;                              ///< see visit

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.reference_points,
      Field{"reference_points", "", 1, 1e7, "at most this many reference points"});
    f(p.narrow_reference_points,
      Field{"narrow_reference_points", "", 0, 1e7,
            "at most this many further ones, with partners from a narrower neighbourhood"});
    f(p.round_size, Field{"round_size", "", 1, 1e7,
                          "reference points at a time, spread evenly over the samples that lie on "
                          "no plane found so far"});
    f(p.partners, Field{"partners", "", 1, 1e5, "at most this many partners per reference point"});
    f(p.neighbourhood,
      Field{"neighbourhood", "", 2.0, 1e4, "partners are nearer than this many sample spacings"});
    f(p.narrowing, Field{"narrowing", "", 1.0, 100.0,
                         "the further reference points look this many times less far"});
    f(p.detail_samples,
      Field{"detail_samples", "", 0, 1e9,
            "samples of planes with fewer are split into patches, as those of no plane"});
    f(p.normal_tolerance, Field{"normal_tolerance", "rad", 0.01, kPi / 4.0,
                                "error allowed in the angle between two normals"});
    f(p.theta_bins, Field{"theta_bins", "", 4, 180, "bins of the direction of a partner plane"});
    f(p.rho_bins, Field{"rho_bins", "", 4, 1000, "bins of the offset of a partner plane"});
    f(p.false_alarms, Field{"false_alarms", "", 1e-12, 1.0,
                            "peaks that clutter may cause, expected number per reference point"});
    f(p.noise_gate,
      Field{"noise_gate", "", 1.0, 10.0, "samples of a plane lie within this many sigmas of it"});
    f(p.flatness, Field{"flatness", "", 0.0, 1.0,
                        "and within this many sample spacings: surfaces are not ideal planes"});
    f(p.seed, Field{"seed", "", 0, 2147483647, "selects reference points and partners"});
  }
};

}  // namespace opp
