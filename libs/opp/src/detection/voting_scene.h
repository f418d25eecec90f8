// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/detection/neighbourhood_grid.h"
#include "opp/detection/voting_params.h"
#include "opp/geometry/point_cloud.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace opp {

/// One sample of the cloud as voting needs it.
struct VotingSample {
  Eigen::Vector3f point, normal;
  float gate;  ///< [m] largest distance from its plane
};

/// Votes needed against clutter, by the number of pairs that could have voted.
struct VoteThresholds {
  explicit VoteThresholds(const VotingParams& params);
  std::vector<int> coplanar, orthogonal;
};

/// The samples of `cloud`, in its order.
std::vector<VotingSample> votingSamples(const OrientedCloud& cloud, const SensorModel& sensor,
                                        const VotingParams& params);

/// The samples, prepared for voting within one radius.
struct VotingScene {
  /// `cloud_samples`: those of `cloud`.
  VotingScene(const OrientedCloud& cloud, const std::vector<VotingSample>& cloud_samples,
              const VotingParams& params, double radius);
  const VotingParams& params;
  double radius;  ///< τ_d [m]
  NeighbourhoodGrid grid;
  std::vector<VotingSample> samples;  ///< in the grid's order: partners lie side by side
  Eigen::Vector3d viewpoint;
};

}  // namespace opp
