// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp {

/// Clustering of hypotheses into the plane graph (`buildPlaneGraph`). Lengths are multiples of the
/// sample spacing or of the noise.
struct GraphParams {
  static constexpr std::string_view kSection = "graph";
  double normal_gate = degToRad(25.0);  ///< see visit
  double noise_gate = 3.0;              ///< see visit
  double flatness = 0.1;                ///< see visit
  double merge_angle = degToRad(10.0);  ///< see visit
  double min_area = 12.0;               ///< see visit
  double min_width = 2.5;               ///< see visit
  /// A patch was tested for being flat; a sample is an average of several.
  double detail_min_area = 8.0;
  double detail_min_width = 1.5;         ///< see visit
  double orthogonality = degToRad(5.0);  ///< see visit
  double edge_reach = 4.0;               ///< see visit
  double min_edge_length = 2.0;          ///< see visit
  int rounds = 2;                        ///< see visit

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.normal_gate, Field{"normal_gate", "rad", 0.01, kPi / 4.0,
                           "a sample supports a plane only if their normals differ by less"});
    f(p.noise_gate, Field{"noise_gate", "", 1.0, 10.0,
                          "a sample supports a plane if it lies within this many sigmas"});
    f(p.flatness, Field{"flatness", "", 0.0, 1.0,
                        "plus this many sample spacings: surfaces are not ideal planes"});
    f(p.merge_angle, Field{"merge_angle", "rad", 0.001, kPi / 4.0,
                           "planes whose normals differ by more are never merged"});
    f(p.min_area, Field{"min_area", "", 3.0, 1e9,
                        "smallest connected support of a plane, in samples (spacing squared)"});
    f(p.min_width,
      Field{"min_width", "", 0.0, 1e6, "smallest width of that support, in sample spacings"});
    f(p.detail_min_area,
      Field{"detail_min_area", "", 3.0, 1e9,
            "the same in clouds with detail, where small planes have patches for samples"});
    f(p.detail_min_width,
      Field{"detail_min_width", "", 0.0, 1e6, "smallest width there, in extents of patches"});
    f(p.orthogonality, Field{"orthogonality", "rad", 0.001, kPi / 4.0,
                             "edges join planes that are orthogonal within this angle"});
    f(p.edge_reach, Field{"edge_reach", "", 0.5, 1000.0,
                          "and have samples within this many spacings of their common line"});
    f(p.min_edge_length, Field{"min_edge_length", "", 0.0, 1000.0,
                               "over at least this many spacings of it, on both planes"});
    f(p.rounds, Field{"rounds", "", 1, 20, "passes of assigning samples and fitting planes"});
  }
};

}  // namespace opp
