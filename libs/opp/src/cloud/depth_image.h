// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sampling_params.h"
#include "opp/cloud/sensor_model.h"
#include "opp/geometry/point_cloud.h"

#include "cloud/point_noise.h"
#include "cloud/range_gate.h"

#include <Eigen/Core>

#include <cstddef>

namespace opp {

/// Angles between neighbouring rays of a grid [rad]; 0: unknown.
struct GridAngles {
  double row = 0.0;  ///< from row to row
  double col = 0.0;
};

/// Medians over the points within the sensor's range. A sample of the grid is enough.
GridAngles gridAngles(const PointCloud& cloud, const SensorModel& sensor);

/// An organized cloud as its sensor saw it: points about the viewpoint, and their noise.
class DepthImage {
 public:
  /// `cloud` must outlive this.
  DepthImage(const PointCloud& cloud, const SensorModel& sensor, const SamplingParams& params);

  Eigen::Vector3d viewpoint() const { return cloud_.viewpoint.cast<double>(); }
  int rows() const { return cloud_.rows; }
  int cols() const { return cloud_.cols; }
  std::size_t size() const { return cloud_.size(); }
  int indexOf(int row, int col) const { return row * cloud_.cols + col; }
  Eigen::Vector3f point(int pixel) const {
    return cloud_.points[static_cast<std::size_t>(pixel)] - cloud_.viewpoint;
  }
  bool inRange(const Eigen::Vector3f& point) const { return gate_.contains(point); }
  /// The closer of the angles between neighbouring rays [rad].
  double pixelAngle() const { return pixel_angle_; }
  /// Of a pixel [sr].
  double solidAngle() const { return solid_angle_; }
  const PointNoise& noise() const { return noise_; }
  const SensorModel& sensor() const { return sensor_; }
  /// Between neighbours of one surface ranges differ by no more than noise and a surface seen at
  /// 80° make them.
  bool jumps(float range_a, float range_b) const;

 private:
  DepthImage(const PointCloud& cloud, const SensorModel& sensor, const SamplingParams& params,
             const GridAngles& angles);

  const PointCloud& cloud_;
  SensorModel sensor_;
  RangeGate gate_;
  double pixel_angle_, solid_angle_;
  PointNoise noise_;
};

}  // namespace opp
