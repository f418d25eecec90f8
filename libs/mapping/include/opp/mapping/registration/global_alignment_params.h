// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/constants.h"
#include "opp/params/field.h"

#include <string_view>

namespace opp::mapping {

/// Parameters of the alignment of two scans without initial guess (DESIGN 3, rung 1).
struct GlobalAlignmentParams {
  static constexpr std::string_view kSection = "global_alignment";
  int samples = 600;
  int screening_samples = 120;
  int max_directions = 12;
  int max_rotations = 48;
  int max_translations = 150;
  int max_verified = 64;
  int max_refined = 12;
  double direction_tolerance = degToRad(8.0);
  double normal_gate = degToRad(35.0);
  double cell_ratio = 3.0;
  double agreement_sigmas = 4.0;
  double distinct_rotation = degToRad(8.0);
  double distinct_cells = 3.0;
  double min_overlap = 0.25;
  double max_conflict = 0.06;
  double min_clarity = 0.2;
  double min_slide_clarity = 0.09;
  double min_observability = 0.005;
  double min_confirmation = 0.04;
  double same_view_overlap = 0.8;

  template <typename Self, typename F>
  static void visit(Self&& p, F&& f) {
    f(p.samples, Field{"samples", "", 20, 1e5, "samples of each scan that verify a pose"});
    f(p.screening_samples,
      Field{"screening_samples", "", 10, 1e5, "samples that sort out the worst poses first"});
    f(p.max_directions,
      Field{"max_directions", "", 2, 1000, "directions of planes used, those of most area"});
    f(p.max_rotations, Field{"max_rotations", "", 1, 1e4, "candidate rotations at most"});
    f(p.max_translations,
      Field{"max_translations", "", 1, 1e5, "candidate translations of a rotation at most"});
    f(p.max_verified, Field{"max_verified", "", 1, 1e5, "screened poses that are verified"});
    f(p.max_refined, Field{"max_refined", "", 2, 1000, "verified poses that are refined"});
    f(p.direction_tolerance, Field{"direction_tolerance", "rad", 0.001, 0.5,
                                   "planes are parallel if their normals differ less"});
    f(p.normal_gate,
      Field{"normal_gate", "rad", 0.01, 1.57, "two samples agree if their normals differ less"});
    f(p.cell_ratio,
      Field{"cell_ratio", "", 1.0, 20.0, "edge of a search cell over the sample spacing"});
    f(p.agreement_sigmas, Field{"agreement_sigmas", "", 1.0, 20.0,
                                "two samples agree if they are so many sigmas apart or less"});
    f(p.distinct_rotation, Field{"distinct_rotation", "rad", 0.01, 1.57,
                                 "poses that differ less, and less than the next, are one"});
    f(p.distinct_cells,
      Field{"distinct_cells", "", 0.5, 100.0, "the same for positions, in edges of a search cell"});
    f(p.min_overlap,
      Field{"min_overlap", "", 0.0, 1.0, "share of the smaller scan that has to agree"});
    f(p.max_conflict, Field{"max_conflict", "", 0.0, 1.0,
                            "share of conflicts with free space among all that speaks"});
    f(p.min_clarity, Field{"min_clarity", "", 0.0, 1.0,
                           "how clearly the samples must prefer the best pose to every other, else "
                           "the answer is: ambiguous"});
    f(p.min_slide_clarity, Field{"min_slide_clarity", "", 0.0, 1.0,
                                 "and to itself moved by a distinct step in any direction, else "
                                 "that direction is not observed"});
    f(p.min_observability, Field{"min_observability", "", 0.0, 0.1,
                                 "share of the samples that must see a motion in each direction"});
    f(p.min_confirmation, Field{"min_confirmation", "", 0.0, 1.0,
                                "share of the agreeing samples that must lie beside the three "
                                "surfaces that fix the pose, else the answer is: unconfirmed"});
    f(p.same_view_overlap, Field{"same_view_overlap", "", 0.0, 1.01,
                                 "unless so much of each scan agrees with the other"});
  }
};

}  // namespace opp::mapping
