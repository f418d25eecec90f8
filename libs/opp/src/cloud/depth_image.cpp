// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/depth_image.h"

#include "opp/geometry/median.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace opp {
namespace {

constexpr double kJumpSigmas = 3.0;
constexpr double kSteepest = 5.7;  // tan 80°

/// Coordinates are in single precision, and so is what is computed with millions of them: errors of
/// a few units in the last place, alike for neighbours.
constexpr double kRoundings = 16.0;

/// The sensor, with what rounding adds to its noise at the farthest of some points.
SensorModel withRounding(SensorModel sensor, const PointCloud& cloud) {
  constexpr std::size_t kSamples = 500;
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / kSamples);
  double farthest = 0.0;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    const double range = (cloud.points[i] - cloud.viewpoint).cast<double>().norm();
    if (range <= sensor.max_range) farthest = std::max(farthest, range);
  }
  farthest = std::max(farthest, cloud.viewpoint.cast<double>().norm());
  const double unit = static_cast<double>(std::numeric_limits<float>::epsilon());
  sensor.noise_constant = std::hypot(sensor.noise_constant, kRoundings * unit * farthest);
  return sensor;
}

double neighborAngle(const PointCloud& cloud, const SensorModel& sensor, int row_step,
                     int col_step) {
  constexpr int kSamples = 500;
  const int rows = cloud.rows - row_step;
  const int cols = cloud.cols - col_step;
  if (rows < 1 || cols < 1) return 0.0;
  const RangeGate gate(sensor.min_range, sensor.max_range);
  const long long total = static_cast<long long>(rows) * cols;
  const long long stride = std::max(1LL, total / kSamples);
  std::vector<double> angles;
  for (long long k = 0; k < total; k += stride) {
    const auto at = static_cast<std::size_t>(k / cols * cloud.cols + k % cols);
    const std::size_t beside =
        at + static_cast<std::size_t>(row_step) * static_cast<std::size_t>(cloud.cols) +
        static_cast<std::size_t>(col_step);
    const Eigen::Vector3f a = cloud.points[at] - cloud.viewpoint;
    const Eigen::Vector3f b = cloud.points[beside] - cloud.viewpoint;
    if (!gate.contains(a) || !gate.contains(b)) continue;
    const Eigen::Vector3d ray = a.cast<double>(), next = b.cast<double>();
    angles.push_back(std::atan2(ray.cross(next).norm(), ray.dot(next)));
  }
  return angles.empty() ? 0.0 : medianOf(std::move(angles));
}

}  // namespace

GridAngles gridAngles(const PointCloud& cloud, const SensorModel& sensor) {
  return {neighborAngle(cloud, sensor, 1, 0), neighborAngle(cloud, sensor, 0, 1)};
}

DepthImage::DepthImage(const PointCloud& cloud, const SensorModel& sensor,
                       const SamplingParams& params)
    : DepthImage(cloud, sensor, params, gridAngles(cloud, sensor)) {}

DepthImage::DepthImage(const PointCloud& cloud, const SensorModel& sensor,
                       const SamplingParams& params, const GridAngles& angles)
    : cloud_(cloud),
      sensor_(sensor),
      gate_(sensor.min_range, sensor.farthestSurface()),
      pixel_angle_(std::min(angles.row, angles.col)),
      solid_angle_(angles.row * angles.col),
      noise_(withRounding(sensor, cloud), params, pixel_angle_) {}

bool DepthImage::jumps(float range_a, float range_b) const {
  const auto far = static_cast<double>(std::max(range_a, range_b));
  const auto step = static_cast<double>(std::abs(range_a - range_b));
  const double variance = 2.0 * noise_.model(far * far, far);  // of a difference
  return step > kJumpSigmas * std::sqrt(variance) + kSteepest * pixel_angle_ * far;
}

}  // namespace opp
