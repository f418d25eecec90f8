// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/core/se3.h"
#include "opp/mapping/registration/local_map.h"
#include "opp/mapping/registration/registration_params.h"

#include <vector>

namespace opp::mapping {

/// What is known of a pose before the scan is looked at. It carries the directions that the scan
/// does not fix.
struct PosePrior {
  Eigen::Isometry3d map_from_body = Eigen::Isometry3d::Identity();
  Matrix6d information =
      Matrix6d::Zero();  ///< of (ω, v), see `retract` [1/rad², 1/m²]; zero: unknown

  /// Squared Mahalanobis distance of a pose to it.
  double squaredSigmas(const Eigen::Isometry3d& pose) const {
    const Vector6d step = difference(map_from_body, pose);
    return step.dot(information * step);
  }
};

/// A plane of the scan that is a plane landmark of the map.
struct PlaneAssociation {
  int scan_plane = 0;
  int landmark = 0;
};

/// Outcome of `matchScan`.
struct MatchResult {
  Eigen::Isometry3d map_from_body = Eigen::Isometry3d::Identity();
  Matrix6d information =
      Matrix6d::Zero();  ///< of (ω, v) from scan and map alone, without the prior
  Matrix6d covariance = Matrix6d::Zero();  ///< of (ω, v) from scan, map and prior; at most about
                                           ///< 1e4 where nothing is known
  /// What the points alone fix; of a tracked scan (`Tracker`), with what motion since the newest
  /// keyframe adds.
  Matrix6d point_information = Matrix6d::Zero();
  std::vector<PlaneAssociation> planes;  ///< in order of scan planes
  double overlap = 0.0;  ///< share of the scan's points that agree with the map, 0–1
  double rms = 0.0;      ///< distance of the agreeing points to their surfels [m]
  bool converged = false;
};

/// Registers a scan against a local map, starting at the prior's pose.
///
/// Stages, each a robust Gauss–Newton iteration (Cauchy kernel, annealed): points against surfels
/// (and rims against rims) from a level that is as coarse as the prior is uncertain down to the
/// finest (or on the finest alone, where that agrees more), then plane landmarks through the
/// moments of the scan's planes (four numbers a plane for all its samples, exact) together with the
/// points that are on no such plane. An empty scan or map gives overlap 0 and the prior's pose.
/// Deterministic. Cost: O(max_points + samples + rims + planes) per step.
MatchResult matchScan(const ScanFeatures& scan, const LocalMap& map, const PosePrior& prior,
                      const RegistrationParams& params);

}  // namespace opp::mapping
