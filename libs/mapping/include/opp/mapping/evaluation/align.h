// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/trajectory.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// A true and an estimated pose of the body at the same moment; the two frames, `gt` and `est`, are
/// unrelated.
struct PosePair {
  double timestamp = 0.0;  ///< [s]
  Eigen::Isometry3d gt_from_body = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d est_from_body = Eigen::Isometry3d::Identity();
};

/// The rigid motion (no scale) that brings the estimated positions closest to the true ones in the
/// sense of least squares: Horn 1987, in the form of Umeyama 1991 (singular value decomposition).
///
/// Positions alone do not always determine the rotation. What they leave open is chosen such that
/// the rotation errors Σ |R_gt − R·R_est|² are smallest, so that the result is well defined:
/// - all positions of one side equal, as with a single pair (or with every pair at rest): the whole
///   rotation comes from the orientations; one pair is aligned exactly.
/// - positions on a straight line: the turn about the line comes from the orientations.
/// "Equal" and "straight" mean: to numerical precision (1 nm, or 1e-5 of the extent).
///
/// \return gt_from_est; identity for no pairs. O(n).
/// \throws std::invalid_argument if a pose is not finite.
Eigen::Isometry3d alignTrajectories(const std::vector<PosePair>& pairs);

/// The rigid motion that brings the estimated poses, positions and orientations together, closest
/// to the true ones: Σ |Δp|²/σ_p² + |ΔR|²/σ_R² is smallest, where both σ are those of the residuals
/// themselves (found by iteration). Where the path is short, positions say little about rotation
/// and orientations much: use this to bring maps into one frame, alignTrajectories for trajectory
/// errors as others define them.
///
/// \return gt_from_est; identity for no pairs. O(n). \throws as alignTrajectories.
Eigen::Isometry3d alignPoses(const std::vector<PosePair>& pairs);

}  // namespace opp::mapping
