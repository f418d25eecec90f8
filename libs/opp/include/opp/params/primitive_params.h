// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/rim_params.h"
#include "opp/cloud/sampling_params.h"
#include "opp/cloud/sensor_model.h"
#include "opp/detection/voting_params.h"
#include "opp/graph/graph_params.h"
#include "opp/narrow/narrow_params.h"
#include "opp/primitives/corner_params.h"
#include "opp/primitives/line_params.h"
#include "opp/refinement/refinement_params.h"

namespace opp {

/// Parameters of all stages from raw points to primitives.
struct PrimitiveParams {
  SensorModel sensor;
  SamplingParams sampling;
  VotingParams voting;
  GraphParams graph;
  NarrowParams narrow;
  RefinementParams refinement;
  CornerParams corners;
  LineParams lines;
  RimParams rims;

  /// Calls f(section) for each stage, in the order of the stages.
  template <typename Self, typename F>
  static void visitSections(Self&& p, F&& f) {
    f(p.sensor);
    f(p.sampling);
    f(p.voting);
    f(p.graph);
    f(p.narrow);
    f(p.refinement);
    f(p.corners);
    f(p.lines);
    f(p.rims);
  }
};

}  // namespace opp
