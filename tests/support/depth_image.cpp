// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/depth_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opp::test {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

RangeAlong insideOf(const std::vector<Plane>& planes) {
  return [planes](const Eigen::Vector3d& ray) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Plane& plane : planes) {
      const double range = -plane.d() / plane.normal().dot(ray);
      if (range > 0.0) nearest = std::min(nearest, range);
    }
    return nearest;
  };
}

RangeAlong outsideOf(const std::vector<Plane>& planes) {
  return [planes](const Eigen::Vector3d& ray) {
    double enter = 0.0;
    double leave = std::numeric_limits<double>::infinity();
    for (const Plane& plane : planes) {
      const double along = plane.normal().dot(ray);
      const double range = -plane.d() / along;
      if (along < 0.0) enter = std::max(enter, range);
      if (along > 0.0) leave = std::min(leave, range);
    }
    return enter < leave ? enter : kNothing;
  };
}

PointCloud renderDepth(const Camera& camera, const RangeAlong& range) {
  PointCloud cloud;
  cloud.rows = camera.rows;
  cloud.cols = camera.cols;
  for (int row = 0; row < camera.rows; ++row) {
    for (int col = 0; col < camera.cols; ++col) {
      const Eigen::Vector3d ray =
          Eigen::Vector3d(camera.focal_length, 0.5 * (camera.cols - 1) - col,
                          0.5 * (camera.rows - 1) - row)
              .normalized();
      const double distance = range(ray);
      const bool hit = std::isfinite(distance) && distance > 0.0;
      cloud.points.emplace_back(((hit ? distance : kNothing) * ray).cast<float>());
    }
  }
  return cloud;
}

void addRangeNoise(PointCloud& cloud, const SensorModel& sensor, Random& random) {
  for (Eigen::Vector3f& point : cloud.points) {
    const Eigen::Vector3d ray = (point - cloud.viewpoint).cast<double>();
    const double range = ray.norm();
    if (!std::isfinite(range) || range <= 0.0) continue;
    point += (ray * (random.normal(sensor.sigma(range)) / range)).cast<float>();
  }
}

}  // namespace opp::test
