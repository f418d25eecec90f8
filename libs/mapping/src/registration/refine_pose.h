// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/se3.h"

#include "registration/scan_model.h"

#include <Eigen/Geometry>

namespace opp::mapping {

/// A refined pose with what the shared surfaces tell about it.
struct RefinedPose {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of (ω, v), see `retract`
  /// Eigenvalues, ascending, of the mean of jjᵀ over the matched samples, where j is the normal and
  /// its moment about their middle in units of their mean distance from it: the share of samples
  /// that see a motion in each of six directions. Zero: nothing fixes that direction.
  Vector6d observability = Vector6d::Zero();
};

/// Point-to-plane refinement (robust, annealed) of a pose that is right to about a search cell: the
/// verification samples of each scan against the planes that hold the other's samples nearby.
/// Directions that nothing fixes stay as they are.
RefinedPose refinePose(const ScanModel& target, const ScanModel& source,
                       const Eigen::Isometry3d& target_from_source,
                       const GlobalAlignmentParams& params);

/// Covariance of (ω, v) of a refined pose: the noise of the samples, the part of it that samples of
/// one plane share, and the sensor's distortion, which neighbouring rays of a scan share.
/// Directions that nothing fixes have a variance without meaning. O(samples).
Matrix6d covarianceAt(const ScanModel& target, const ScanModel& source,
                      const Eigen::Isometry3d& target_from_source,
                      const GlobalAlignmentParams& params);

/// What the shared surfaces tell about a pose that stays as it is.
RefinedPose informationAt(const ScanModel& target, const ScanModel& source,
                          const Eigen::Isometry3d& target_from_source,
                          const GlobalAlignmentParams& params);

}  // namespace opp::mapping
