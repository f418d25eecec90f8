// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sampling_params.h"
#include "opp/cloud/sensor_model.h"
#include "opp/geometry/point_cloud.h"
#include "opp/primitives/stage_timings.h"

namespace opp {

/// Turns raw points into evenly spaced surface samples with normals (Sommer et al. 2020, V-b).
///
/// Points outside the sensor's range and points that are not finite are ignored. Given normals are
/// normalized and used as they are (points without a finite, non-zero one are dropped); otherwise
/// planes are fitted in windows that grow until the normal is certain enough for the sensor's noise
/// at that range: in the grid of an organized cloud, among nearest neighbours of an unorganized
/// one. Near an edge the window moves to one side; where no window is flat the surface is dropped,
/// not guessed. All normals are turned to the viewpoint.
///
/// Empty result if nothing is left (no points, a line of points). Deterministic, one thread.
/// O(points) if organized or with normals, else O(points log points). Fills its stages in `timings`
/// unless null.
/// \throws std::invalid_argument if rows·cols or the number of normals does not fit the points, or
/// a parameter is out of range.
OrientedCloud makeOrientedCloud(const PointCloud& cloud, const SensorModel& sensor,
                                const SamplingParams& params, StageTimings* timings = nullptr);

}  // namespace opp
