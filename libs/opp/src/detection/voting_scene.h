// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/detection/neighbourhood_grid.h"
#include "opp/detection/voting_params.h"
#include "opp/geometry/point_cloud.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// One sample of the cloud as voting needs it.
struct VotingSample {
  Eigen::Vector3f point, normal;
  float gate;    ///< [m] largest distance from its plane
  float extent;  ///< [m] of the surface that it stands for
};

/// Votes needed against clutter, by the number of pairs that could have voted.
struct VoteThresholds {
  explicit VoteThresholds(const VotingParams& params);
  std::vector<int> coplanar, orthogonal;
};

/// The samples of `cloud` from `begin` on, in its order.
std::vector<VotingSample> votingSamples(const OrientedCloud& cloud, std::size_t begin,
                                        const SensorModel& sensor, const VotingParams& params);

/// The samples, prepared for voting within one radius.
struct VotingScene {
  VotingScene(const std::vector<VotingSample>& samples, const Eigen::Vector3f& viewpoint,
              const VotingParams& params, double radius, double spacing);
  const VotingParams& params;
  double radius;        ///< τ_d [m]
  double spacing;       ///< of the samples [m]
  bool detail = false;  ///< surfaces nearer than a spacing are to be told apart
  NeighbourhoodGrid grid;
  std::vector<VotingSample> samples;  ///< in the grid's order: partners lie side by side
  Eigen::Vector3d viewpoint;
};

}  // namespace opp
