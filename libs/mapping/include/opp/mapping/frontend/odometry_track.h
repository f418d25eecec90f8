// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/trajectory.h"

#include <optional>

namespace opp::mapping {

/// The latest odometry of a rawlog, to be asked for the pose at a scan's time.
class OdometryTrack {
 public:
  /// Takes a reading; readings come in the order of the file. One that is not newer than the last
  /// replaces it.
  void add(double timestamp, const Eigen::Isometry3d& odom_from_body);

  /// Pose at `timestamp`, carried on from the last reading at the speed of the last two; nothing if
  /// there is no reading within `kMaxAge` of it.
  std::optional<Eigen::Isometry3d> at(double timestamp) const;

  static constexpr double kMaxAge =
      0.5;  ///< [s] older readings say nothing of a hand-held or driving body

 private:
  std::optional<StampedPose> before_last_;
  std::optional<StampedPose> last_;
};

}  // namespace opp::mapping
