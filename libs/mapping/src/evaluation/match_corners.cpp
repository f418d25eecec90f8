// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/geometry/constants.h"

#include "evaluation/primitive_matching.h"

#include <cmath>

namespace opp::mapping {
namespace {

/// Angle between two corner frames, whose axes may be permuted and turned round [rad]. Below 45°
/// the axis of one that belongs to an axis of the other is the one with the greatest product; π
/// where that is no one-to-one relation.
double angleBetweenFrames(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Matrix3d a_from_b = (a.conjugate() * b).toRotationMatrix();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
  for (int column = 0; column < 3; ++column) {
    Eigen::Index row = 0;
    a_from_b.col(column).cwiseAbs().maxCoeff(&row);
    axes(row, column) = a_from_b(row, column) < 0.0 ? -1.0 : 1.0;
  }
  if (axes.determinant() < 0.5) return kPi;
  const Eigen::Quaterniond rest(Eigen::Matrix3d(a_from_b * axes.transpose()));
  return 2.0 * std::atan2(rest.vec().norm(), std::abs(rest.w()));
}

std::vector<PrimitiveCandidate> sameCorners(const std::vector<PlanarMapCorner>& gt,
                                            const std::vector<PlanarMapCorner>& est,
                                            const PrimitiveErrorParams& params) {
  std::vector<PrimitiveCandidate> candidates;
  for (std::size_t g = 0; g < gt.size(); ++g) {
    for (std::size_t e = 0; e < est.size(); ++e) {
      const double distance = (gt[g].position - est[e].position).norm();
      if (distance > params.max_distance) continue;
      const double angle = angleBetweenFrames(gt[g].orientation, est[e].orientation);
      if (angle > params.max_angle) continue;
      candidates.push_back(
          {g, e, angle, distance, angle / params.max_angle + distance / params.max_distance});
    }
  }
  return candidates;
}

}  // namespace

PrimitiveMatching matchCorners(const PlanarMap& gt, const PlanarMap& est,
                               const PrimitiveErrorParams& params) {
  return matchPrimitives(std::vector<double>(gt.corners.size(), 1.0), est.corners.size(),
                         sameCorners(gt.corners, est.corners, params),
                         sameCorners(gt.barely_seen.corners, est.corners, params),
                         [](std::size_t, std::size_t) { return false; });
}

}  // namespace opp::mapping
