// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/oriented_cloud.h"
#include "opp/cloud/sensor_model.h"
#include "opp/detection/voting_params.h"
#include "opp/geometry/plane.h"
#include "opp/geometry/point_cloud.h"

#include <Eigen/Core>

#include <vector>

namespace opp {

/// A plane that one reference point voted for, fitted to the partners that voted.
struct PlaneHypothesis {
  Plane plane;                                       ///< n points to the viewpoint's side
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< on the plane, amid its voters
  double votes = 0.0;                                ///< voters within the noise of the plane
  double reach = 0.0;    ///< [m] voters, and samples of the plane, are within it of the anchor
  /// [m] Parallel surfaces twice as far apart are told apart by their samples' noise and spacing.
  double resolution = 0.0;
};

/// Two orthogonal hypotheses of one reference point (an OPP).
struct OrthogonalPair {
  int reference = 0;   ///< index of the plane through the reference point
  int partner = 0;     ///< index of the orthogonal plane
  double votes = 0.0;  ///< votes in the peak (θ, ρ)
};

/// Everything the reference points voted for. Planes without a pair are lone planes.
struct OppHypotheses {
  std::vector<PlaneHypothesis> planes;
  std::vector<OrthogonalPair> pairs;
};

/// Local Hough voting for orthogonal plane pairs (Sommer et al. 2020, III-a and III-b). N reference
/// points are paired with ≤ K partners each, drawn evenly from the ball of radius τ_d about them;
/// each pair casts one vote: coplanar, orthogonal (θ, ρ), or none. A reference point with more
/// coplanar votes than clutter explains gives a plane, each peak of (θ, ρ) above clutter an
/// orthogonal plane to it. The signs of the cloud's normals do not matter.
///
/// Empty for clouds of fewer than three samples or without spacing. Same result for every `threads`
/// (≤ 0: all cores). O(size + N·K).
/// \throws std::invalid_argument if a parameter is out of range.
OppHypotheses detectOpps(const OrientedCloud& cloud, const SensorModel& sensor,
                         const VotingParams& params, int threads = 1);

/// As above; samples that lie on no plane of the wide neighbourhoods are split into their patches
/// (`splitSamples`) before the narrow ones vote.
OppHypotheses detectOpps(ScanSurface& surface, const SensorModel& sensor,
                         const VotingParams& params, int threads = 1);

}  // namespace opp
