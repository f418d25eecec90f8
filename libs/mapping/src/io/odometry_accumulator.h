// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/io/rawlog_reader.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <optional>

namespace opp::mapping {

/// Brings absolute odometry and the increments of action/frame rawlogs to one form. A rawlog with
/// absolute readings is taken at its word: increments in it are then ignored.
class OdometryAccumulator {
 public:
  /// Takes in the increment of an action; its reading comes with the next observation.
  void add(const mrpt::obs::CActionCollection& action);
  OdometryReading reading(const mrpt::obs::CObservationOdometry& observation);
  /// The reading of the actions since the last call, stamped with the observation they lead to.
  std::optional<OdometryReading> takePending(double timestamp);

 private:
  Eigen::Isometry3d odom_from_body_ = Eigen::Isometry3d::Identity();
  bool pending_ = false;
  bool absolute_ = false;
};

}  // namespace opp::mapping
