// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/se3.h"

#include "registration/scan_model.h"

#include <Eigen/Geometry>

namespace opp::mapping {

/// A refined pose with the information that the shared surfaces give about it.
struct RefinedPose {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of (ω, v), see `retract`
};

/// Point-to-plane refinement of a pose that is right to about a search cell: first the verification
/// samples of the source alone, then planes that both scans share through the moments of all their
/// samples (four numbers a plane) and the other samples as points. Robust, annealed.
/// Directions that nothing fixes stay as they are.
RefinedPose refinePose(const ScanModel& target, const ScanModel& source,
                       const Eigen::Isometry3d& target_from_source,
                       const GlobalAlignmentParams& params);

}  // namespace opp::mapping
