// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"

#include <mrpt/obs/CObservationRotatingScan.h>

namespace opp::mapping {

/// Organized cloud of one sweep in the sensor's frame: rows from the highest to the lowest beam,
/// columns in the order of firing; columns without any return are left out.
/// \throws std::runtime_error if the lidar model's beam angles are unknown or nothing was measured.
PointCloud rotatingScanInSensor(const mrpt::obs::CObservationRotatingScan& scan);

}  // namespace opp::mapping
