// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/geometry/plane.h"
#include "opp/geometry/point_cloud.h"

#include "support/random.h"

#include <functional>
#include <vector>

namespace opp::test {

/// Pinhole camera at the origin that looks along +x (y left, z up). The default is a Kinect.
struct Camera {
  int rows = 480;
  int cols = 640;
  double focal_length = 525.0;  ///< [pixels]
};

/// Range along a unit ray from the origin; not finite or not positive: nothing there.
using RangeAlong = std::function<double(const Eigen::Vector3d& ray)>;

/// What a camera at the origin sees from inside the convex space in front of all planes.
RangeAlong insideOf(const std::vector<Plane>& planes);

/// What a camera at the origin sees of the convex solid behind all planes (normals point outward).
RangeAlong outsideOf(const std::vector<Plane>& planes);

/// Organized cloud of the pixels' points; NaN where there is nothing.
PointCloud renderDepth(const Camera& camera, const RangeAlong& range);

/// Adds the sensor's noise along each ray.
void addRangeNoise(PointCloud& cloud, const SensorModel& sensor, Random& random);

}  // namespace opp::test
