// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/map_state.h"

namespace opp::mapping {

/// Covariance of (α, β, δ), see `tangentBasis`, of a plane landmark: the noise of its samples and,
/// of each keyframe that saw it, the sensor's distortion, which no number of samples averages out:
/// it is one error over the length within which distortion changes, another one beyond.
/// O(observations).
Eigen::Matrix3d landmarkCovariance(const PlaneLandmark& landmark, const MapState& map,
                                   const SensorModel& sensor);

/// Standard deviation of where the plane passes at `point`, a point on it [m].
double positionDeviation(const Eigen::Vector3d& point, const Plane& plane,
                         const Eigen::Matrix3d& covariance);

}  // namespace opp::mapping
