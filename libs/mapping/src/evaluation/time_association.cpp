// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/time_association.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace opp::mapping {
namespace {

Eigen::Isometry3d interpolate(const StampedPose& a, const StampedPose& b, double timestamp) {
  if (timestamp == a.timestamp) return a.map_from_body;
  if (timestamp == b.timestamp) return b.map_from_body;
  const double u = (timestamp - a.timestamp) / (b.timestamp - a.timestamp);
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() =
      (1.0 - u) * a.map_from_body.translation() + u * b.map_from_body.translation();
  const Eigen::Quaterniond rotation_a(a.map_from_body.linear());
  const Eigen::Quaterniond rotation_b(b.map_from_body.linear());
  result.linear() = rotation_a.slerp(u, rotation_b).normalized().toRotationMatrix();
  return result;
}

void requireAscending(const Trajectory& trajectory, const char* name) {
  for (std::size_t k = 0; k + 1 < trajectory.size(); ++k) {
    if (!(trajectory[k].timestamp < trajectory[k + 1].timestamp)) {
      throw std::invalid_argument(std::string("associateByTime: the times of the ") + name +
                                  " do not ascend");
    }
  }
}

}  // namespace

std::optional<Eigen::Isometry3d> poseAt(const Trajectory& trajectory, double timestamp,
                                        const AssociationParams& params) {
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), timestamp,
                       [](const StampedPose& pose, double time) { return pose.timestamp < time; });
  const bool has_after = after != trajectory.end();
  const bool has_before = after != trajectory.begin();
  if (has_after && has_before &&
      after->timestamp - (after - 1)->timestamp <= params.max_interpolation_gap) {
    return interpolate(*(after - 1), *after, timestamp);
  }
  const double to_after = has_after ? after->timestamp - timestamp : kUnbounded;
  const double to_before = has_before ? timestamp - (after - 1)->timestamp : kUnbounded;
  if (!(std::min(to_after, to_before) <= params.max_time_difference)) return std::nullopt;
  return to_after <= to_before ? after->map_from_body : (after - 1)->map_from_body;
}

std::vector<PosePair> associateByTime(const Trajectory& ground_truth, const Trajectory& estimate,
                                      const AssociationParams& params) {
  validate(params);
  requireAscending(ground_truth, "ground truth");
  requireAscending(estimate, "estimate");
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : estimate) {
    const auto gt_from_body = poseAt(ground_truth, pose.timestamp, params);
    if (gt_from_body) pairs.push_back({pose.timestamp, *gt_from_body, pose.map_from_body});
  }
  return pairs;
}

}  // namespace opp::mapping
