// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/detection/detect_opps.h"

#include "detection/voting_scene.h"

#include <Eigen/Core>

#include <optional>

namespace opp {

/// Mean of the voters' normals, each turned to the side of the unit vector `start`, and of `start`.
Eigen::Vector3d meanNormal(const VotingScene& scene, const Voters& voters,
                           const Eigen::Vector3d& start);

/// A voter whose height along `normal` most others share: mode of the heights, so that parallel
/// surfaces within one peak do not mix. Needs voters.
Eigen::Vector3d densestHeight(const VotingScene& scene, const Voters& voters,
                              const Eigen::Vector3d& normal);

/// Plane through those voters that lie within the noise of it, starting from the plane (`origin`,
/// `normal`). Empty if fewer than `min_votes` are left.
std::optional<PlaneHypothesis> fitVoters(const VotingScene& scene, const Voters& voters,
                                         const Eigen::Vector3d& origin,
                                         const Eigen::Vector3d& normal, int min_votes);

}  // namespace opp
