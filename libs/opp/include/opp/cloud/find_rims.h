// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/rim_params.h"
#include "opp/cloud/sensor_model.h"
#include "opp/geometry/point_cloud.h"

#include <cstddef>
#include <vector>

namespace opp {

/// Points on the rims of surfaces: where a surface ends before something farther away, such as the
/// frame of a window or the edge of a table. They are places on the surface in front, so they stay
/// where they are when the sensor moves; past a bare wall they may be all that does not slide along
/// it. All vectors have the same length.
struct Rims {
  std::vector<Eigen::Vector3f> points;   ///< [m]
  std::vector<Eigen::Vector3f> normals;  ///< unit length, across rim and ray, away from the surface
  std::vector<float> sigmas;             ///< [m] standard deviation of the place along the normal

  std::size_t size() const { return points.size(); }
};

/// Finds the rims in a depth image: in each square of the image one for each of the four sides on
/// which a surface may end, where the pixels at which it does lie on a straight line. Nothing in
/// clouds without a grid, nor in those of a spinning lidar, whose rings are too far apart.
/// Deterministic. O(points). \throws std::invalid_argument if a parameter is out of range or the
/// grid does not fit the points.
Rims findRims(const PointCloud& cloud, const SensorModel& sensor, const RimParams& params);

}  // namespace opp
