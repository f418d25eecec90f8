// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/frontend/lost_scans.h"

#include "opp/mapping/frontend/motion_model.h"
#include "opp/mapping/registration/local_map.h"

#include "registration/observability.h"

#include <cmath>

namespace opp::mapping {

bool deniedByLostScans(const std::vector<LostScan>& lost, const ScanFeatures& found,
                       const Eigen::Isometry3d& map_from_body, const MapperParams& params) {
  if (lost.empty()) return false;
  LocalMap seen(found.cloud_in_body.spacing, params.primitives.sensor, params.registration);
  seen.insert(found, Eigen::Isometry3d::Identity(),
              std::vector<int>(found.primitives_in_body.planes.size(), -1));
  PosePrior near;
  double timestamp = found.timestamp;
  for (auto before = lost.rbegin(); before != lost.rend(); ++before) {
    const double seconds = std::abs(timestamp - before->scan.timestamp);
    near.information = typicalMotion(seconds, params.frontend).cwiseInverse().asDiagonal();
    const MatchResult match = matchScan(before->scan, seen, near, params.registration);
    if (match.overlap < params.frontend.doubtful_overlap ||
        !isKnown(match.covariance, params.frontend))
      return false;
    if (before->predicted.squaredSigmas(map_from_body * match.map_from_body) > kPossible)
      return true;
    near.map_from_body = match.map_from_body;
    timestamp = before->scan.timestamp;
  }
  return false;
}

}  // namespace opp::mapping
