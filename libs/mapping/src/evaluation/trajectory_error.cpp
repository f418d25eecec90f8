// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/evaluation/trajectory_error.h"

#include "opp/mapping/evaluation/align.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace opp::mapping {
namespace {

/// Reach of an estimated pose in time, as a share of the median step; see
/// TrajectoryError::coverage.
constexpr double kReachInSteps = 0.75;

/// Angle of a rotation in [0, π] [rad]; accurate near zero, unlike the arc cosine of the trace.
double angleOf(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

double medianStep(const Trajectory& trajectory) {
  std::vector<double> steps;
  for (std::size_t k = 0; k + 1 < trajectory.size(); ++k) {
    steps.push_back(trajectory[k + 1].timestamp - trajectory[k].timestamp);
  }
  return statisticsOf(std::move(steps)).median;
}

double coverageOf(const Trajectory& ground_truth, const Trajectory& estimate,
                  const AssociationParams& params) {
  const double reach = std::max(params.max_time_difference, kReachInSteps * medianStep(estimate));
  const AssociationParams nearest{0.0, reach};
  const auto covered =
      std::count_if(ground_truth.begin(), ground_truth.end(), [&](const StampedPose& pose) {
        return poseAt(estimate, pose.timestamp, nearest).has_value();
      });
  return static_cast<double>(covered) / static_cast<double>(ground_truth.size());
}

/// Errors of the motions from pairs[i] to pairs[j], divided by `length`.
struct RelativeErrors {
  std::vector<double> translation;
  std::vector<double> rotation;

  void add(const PosePair& i, const PosePair& j, double length) {
    const Eigen::Isometry3d gt_i_from_j = i.gt_from_body.inverse() * j.gt_from_body;
    const Eigen::Isometry3d est_i_from_j = i.est_from_body.inverse() * j.est_from_body;
    const Eigen::Isometry3d error = gt_i_from_j.inverse() * est_i_from_j;
    translation.push_back(error.translation().norm() / length);
    rotation.push_back(angleOf(error.linear()) / length);
  }
};

/// Length of the true path from the first pair to each pair [m].
std::vector<double> pathLengths(const std::vector<PosePair>& pairs) {
  std::vector<double> lengths(pairs.size(), 0.0);
  for (std::size_t k = 1; k < pairs.size(); ++k) {
    const Eigen::Vector3d step =
        pairs[k].gt_from_body.translation() - pairs[k - 1].gt_from_body.translation();
    lengths[k] = lengths[k - 1] + step.norm();
  }
  return lengths;
}

void measureAbsolute(const std::vector<PosePair>& pairs, TrajectoryError& result) {
  std::vector<double> translation;
  std::vector<double> rotation;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d position = result.gt_from_est * pair.est_from_body.translation();
    translation.push_back((pair.gt_from_body.translation() - position).norm());
    // Positions of a short or straight path leave the rotation open by degrees; orientations do
    // not.
    const Eigen::Matrix3d orientation =
        result.gt_map_from_est_map.linear() * pair.est_from_body.linear();
    rotation.push_back(angleOf(pair.gt_from_body.linear().transpose() * orientation));
  }
  result.ate_translation = statisticsOf(std::move(translation));
  result.ate_rotation = statisticsOf(std::move(rotation));
}

void measureRelative(const std::vector<PosePair>& pairs, double distance, TrajectoryError& result) {
  RelativeErrors per_frame;
  RelativeErrors per_metre;
  const std::vector<double> lengths = pathLengths(pairs);
  for (std::size_t i = 0; i + 1 < pairs.size(); ++i) {
    per_frame.add(pairs[i], pairs[i + 1], 1.0);
    const auto far = std::lower_bound(lengths.begin(), lengths.end(), lengths[i] + distance);
    if (far == lengths.end()) continue;
    const auto j = static_cast<std::size_t>(far - lengths.begin());
    per_metre.add(pairs[i], pairs[j], lengths[j] - lengths[i]);
  }
  result.path_length = lengths.back();
  result.rpe_frame_translation = statisticsOf(std::move(per_frame.translation));
  result.rpe_frame_rotation = statisticsOf(std::move(per_frame.rotation));
  result.rpe_metre_translation = statisticsOf(std::move(per_metre.translation));
  result.rpe_metre_rotation = statisticsOf(std::move(per_metre.rotation));
}

[[noreturn]] void failUnmatched(const Trajectory& ground_truth, const Trajectory& estimate,
                                const AssociationParams& params) {
  std::ostringstream message;
  message.precision(16);
  message << "nothing to compare: no estimated pose within " << params.max_time_difference
          << " s of a true one";
  const auto describe = [&](const char* name, const Trajectory& t) {
    message << "; " << name << ": " << t.size() << " poses";
    if (!t.empty()) message << ", " << t.front().timestamp << " to " << t.back().timestamp << " s";
  };
  describe("truth", ground_truth);
  describe("estimate", estimate);
  throw std::invalid_argument(message.str());
}

}  // namespace

TrajectoryError trajectoryError(const Trajectory& ground_truth, const Trajectory& estimate,
                                const TrajectoryErrorParams& params) {
  validate(params);
  const std::vector<PosePair> pairs = associateByTime(ground_truth, estimate, params.association);
  if (pairs.empty()) failUnmatched(ground_truth, estimate, params.association);
  TrajectoryError result;
  result.gt_poses = ground_truth.size();
  result.est_poses = estimate.size();
  result.matched = pairs.size();
  result.coverage = coverageOf(ground_truth, estimate, params.association);
  result.gt_from_est = alignTrajectories(pairs);
  result.gt_map_from_est_map = alignPoses(pairs);
  measureAbsolute(pairs, result);
  measureRelative(pairs, params.rpe_distance, result);
  return result;
}

}  // namespace opp::mapping
