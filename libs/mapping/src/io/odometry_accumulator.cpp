// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/odometry_accumulator.h"

#include "opp/mapping/io/mrpt_convert.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>

namespace opp::mapping {
namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CActionRobotMovement3D;
using mrpt::poses::CPose3D;

/// In 2D the raw reading where there is one: the mean may come from a few hundred particles. In 3D
/// MRPT 2.5 writes the mean alone.
std::optional<CPose3D> incrementOf(const mrpt::obs::CAction& action) {
  if (const auto* move = dynamic_cast<const CActionRobotMovement3D*>(&action)) {
    return move->poseChange.mean;
  }
  if (const auto* move = dynamic_cast<const CActionRobotMovement2D*>(&action)) {
    const bool raw = move->estimationMethod == CActionRobotMovement2D::emOdometry &&
                     move->rawOdometryIncrementReading != mrpt::poses::CPose2D();
    if (raw) return CPose3D(move->rawOdometryIncrementReading);
    if (move->poseChange) return CPose3D(move->poseChange->getMeanVal());
  }
  return std::nullopt;
}

}  // namespace

void OdometryAccumulator::add(const mrpt::obs::CActionCollection& action) {
  if (absolute_) return;
  for (const auto& part : action) {
    const std::optional<CPose3D> increment = part ? incrementOf(*part.get_ptr()) : std::nullopt;
    if (!increment) continue;
    odom_from_body_ = odom_from_body_ * toIsometry(*increment);
    pending_ = true;
    return;  // further movements of one action are other estimates of the same motion
  }
}

OdometryReading OdometryAccumulator::reading(const mrpt::obs::CObservationOdometry& observation) {
  absolute_ = true;
  pending_ = false;
  return {toSeconds(observation.timestamp), toIsometry(CPose3D(observation.odometry))};
}

std::optional<OdometryReading> OdometryAccumulator::takePending(double timestamp) {
  if (!pending_) return std::nullopt;
  pending_ = false;
  return OdometryReading{timestamp, odom_from_body_};
}

}  // namespace opp::mapping
