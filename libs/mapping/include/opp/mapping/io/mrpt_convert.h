// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3D.h>

namespace opp::mapping {

/// The same transform as an Eigen type.
Eigen::Isometry3d toIsometry(const mrpt::poses::CPose3D& pose);
/// The same transform as an MRPT type.
mrpt::poses::CPose3D toCPose3D(const Eigen::Isometry3d& transform);
/// Unix time [s]; 0 for MRPT's "invalid" timestamp.
double toSeconds(const mrpt::Clock::time_point& time);

}  // namespace opp::mapping
