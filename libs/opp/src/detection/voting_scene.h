// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/detection/neighbourhood_grid.h"
#include "opp/detection/vote_table.h"
#include "opp/detection/voting_params.h"
#include "opp/geometry/point_cloud.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace opp {

/// Positions in VotingScene::samples.
using Voters = std::vector<std::uint32_t>;

/// One sample of the cloud as voting needs it.
struct VotingSample {
  Eigen::Vector3f point, normal;
  float gate;  ///< [m] largest distance from its plane
};

/// Votes needed against clutter, by the number of pairs that could have voted.
struct VoteThresholds {
  std::vector<int> coplanar, orthogonal;
};

/// The cloud, prepared for voting within one radius.
struct VotingScene {
  const VotingParams& params;
  double radius;  ///< τ_d [m]
  NeighbourhoodGrid grid;
  std::vector<VotingSample> samples;  ///< in the grid's order: partners lie side by side
  VoteThresholds thresholds;
  Eigen::Vector3d viewpoint;
};

VotingScene makeVotingScene(const OrientedCloud& cloud, const SensorModel& sensor,
                            const VotingParams& params, double radius);

/// What the pairs of one reference point voted for; reused for the next one.
struct LocalVotes {
  LocalVotes(const VotingParams& params, double radius)
      : orthogonal(params.theta_bins, params.rho_bins, radius) {}
  VoteTable orthogonal;
  Voters coplanar;
  std::size_t pairs = 0;  ///< partners within the radius
  std::vector<NeighbourhoodGrid::Range> cells;
};

/// Pairs the sample `r` with ≤ K partners drawn evenly from the cells about it (Eq. 2–4).
void castVotes(const VotingScene& scene, std::uint32_t r, LocalVotes& votes);

}  // namespace opp
