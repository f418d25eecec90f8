// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/backend/backend_params.h"
#include "opp/mapping/checkpoint/checkpoint_params.h"
#include "opp/mapping/dense/occupancy_params.h"
#include "opp/mapping/frontend/frontend_params.h"
#include "opp/mapping/loop/loop_params.h"
#include "opp/mapping/planar/planar_params.h"
#include "opp/mapping/registration/corner_icp_params.h"
#include "opp/mapping/registration/global_alignment_params.h"
#include "opp/mapping/registration/registration_params.h"
#include "opp/params/primitive_params.h"

#include <utility>

namespace opp::mapping {

/// Parameters of all stages from rawlog to map.
struct MapperParams {
  PrimitiveParams primitives;
  RegistrationParams registration;
  GlobalAlignmentParams global_alignment;
  CornerIcpParams corner_icp;
  FrontendParams frontend;
  BackendParams backend;
  LoopParams loop;
  OccupancyParams occupancy;
  PlanarParams planar;
  CheckpointParams checkpoint;

  /// Calls f(section) for each stage, in the order of the stages.
  template <typename Self, typename F>
  static void visitSections(Self&& p, F&& f) {
    PrimitiveParams::visitSections(p.primitives, f);
    f(p.registration);
    f(p.global_alignment);
    f(p.corner_icp);
    f(p.frontend);
    f(p.backend);
    f(p.loop);
    f(p.occupancy);
    f(p.planar);
    f(p.checkpoint);
  }
};

}  // namespace opp::mapping
