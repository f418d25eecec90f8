// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/primitive_error.h"

#include "opp/geometry/constants.h"
#include "opp/mapping/core/move_planar_map.h"

#include "evaluation/primitive_matching.h"

#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace opp::mapping {
namespace {

using IdPair = std::pair<int, int>;  ///< ascending

/// All pairs of planes that a map claims to be orthogonal.
std::set<IdPair> claimsOf(const PlanarMap& map) {
  std::set<IdPair> claims;
  for (const PlanarMapPlane& plane : map.planes) {
    for (const int other : plane.orthogonal_to) claims.insert(std::minmax(plane.id, other));
  }
  for (const PlanarMapLine& line : map.lines) {
    claims.insert(std::minmax(line.planes[0], line.planes[1]));
  }
  for (const PlanarMapCorner& corner : map.corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      claims.insert(std::minmax(corner.planes[k], corner.planes[(k + 1) % 3]));
    }
  }
  return claims;
}

/// In a single scan the origin is the sensor, and corners are measured the worse the farther off.
PrimitiveTally cornerTally(const PlanarMap& gt, const PlanarMap& est,
                           const PrimitiveErrorParams& params) {
  PrimitiveMatching matching = matchCorners(gt, est, params);
  if (gt.frame != "sensor") return matching.tally;
  for (std::size_t e = 0; e < est.corners.size(); ++e) {
    if (matching.gt_of_est[e] < 0) continue;
    const PlanarMapCorner& truth = gt.corners[static_cast<std::size_t>(matching.gt_of_est[e])];
    if (truth.position.norm() > params.near_range) continue;
    matching.tally.near_distances.push_back((truth.position - est.corners[e].position).norm());
  }
  return matching.tally;
}

OrthogonalityTally checkOrthogonality(const PlanarMap& est,
                                      const std::vector<const PlanarMapPlane*>& truth_of_est,
                                      double tolerance) {
  std::map<int, const Plane*> truth_of;
  for (std::size_t e = 0; e < est.planes.size(); ++e) {
    if (truth_of_est[e] != nullptr) truth_of[est.planes[e].id] = &truth_of_est[e]->plane;
  }
  OrthogonalityTally tally;
  for (const auto& [a, b] : claimsOf(est)) {
    ++tally.claimed;
    const auto truth_a = truth_of.find(a);
    const auto truth_b = truth_of.find(b);
    if (truth_a == truth_of.end() || truth_b == truth_of.end()) continue;
    ++tally.checked;
    const double angle = angleBetween(*truth_a->second, *truth_b->second);
    tally.wrong += std::abs(angle - kPi / 2.0) > tolerance;
  }
  return tally;
}

}  // namespace

PrimitiveTallies comparePrimitives(const PlanarMap& ground_truth, const PlanarMap& estimate,
                                   const PrimitiveErrorParams& params,
                                   const Eigen::Isometry3d& gt_from_est) {
  validate(params);
  if (!gt_from_est.matrix().allFinite()) {
    throw std::invalid_argument("comparePrimitives: gt_from_est is not finite");
  }
  const PlanarMap est = movedPlanarMap(gt_from_est, estimate);
  const PlaneMatching planes = matchPlanes(ground_truth, est, params);
  PrimitiveTallies tallies;
  tallies.maps = 1;
  tallies.planes = planes.tally;
  tallies.lines = matchLines(ground_truth, est, params).tally;
  tallies.corners = cornerTally(ground_truth, est, params);
  tallies.orthogonality = checkOrthogonality(est, planes.truth_of_est, params.false_orthogonality);
  return tallies;
}

}  // namespace opp::mapping
