// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_moments.h"
#include "opp/mapping/core/se3.h"

#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace opp::mapping {

/// A keyframe saw a plane landmark: all samples on it, as moments in the keyframe's body frame with
/// weights 1/variance.
struct PlaneFactor {
  int keyframe = 0;
  int landmark = 0;
  PointMoments moments_in_body;
  double effective_samples = 0.0;  ///< independent samples that they are worth
};

/// Relative pose of two keyframes from points that are on no landmark, or from odometry.
struct RelativePoseFactor {
  int first = 0;
  int second = 0;
  Eigen::Isometry3d first_from_second = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of (ω, v) in the frame of `first`, see `retract`
  /// A claim that two places are one: the optimization may come to disbelieve it.
  bool is_loop = false;
};

/// Two plane landmarks that scans showed to meet at a right angle.
struct OrthogonalityFactor {
  std::array<int, 2> landmarks{};
};

/// Two plane landmarks that scans showed to be parallel (normals equal or opposite).
struct ParallelismFactor {
  std::array<int, 2> landmarks{};
};

/// All that ties poses and landmarks together.
struct MapFactors {
  std::vector<PlaneFactor> planes;  ///< of a keyframe in the order of its planes
  std::vector<RelativePoseFactor> relative_poses;
  std::vector<OrthogonalityFactor> orthogonalities;  ///< each pair once, ascending ids
  std::vector<ParallelismFactor> parallelisms;       ///< each pair once, ascending ids
};

}  // namespace opp::mapping
