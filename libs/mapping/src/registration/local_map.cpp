// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/local_map.h"

#include "opp/mapping/registration/plane_samples.h"

#include <Eigen/Geometry>

#include <utility>

namespace opp::mapping {

LocalMap::LocalMap(double spacing, const SensorModel& sensor, const RegistrationParams& params)
    : sensor_(sensor), normal_variance_(params.normal_noise * params.normal_noise) {
  double voxel_size = params.surfel_size_ratio * spacing;
  for (int level = 0; level < params.levels; ++level, voxel_size *= params.level_ratio) {
    const SurfelMap empty(voxel_size, params.normal_gate);
    levels_.push_back({empty, empty});
  }
}

void LocalMap::insert(const ScanFeatures& scan, const Eigen::Isometry3d& map_from_body,
                      const std::vector<int>& landmark_of_plane) {
  const OrientedCloud& cloud = scan.cloud_in_body;
  const Eigen::Isometry3f pose = map_from_body.cast<float>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f point = pose * cloud.points[i];
    const Eigen::Vector3f normal = pose.linear() * cloud.normals[i];
    const float variance = sampleVariance(cloud, i, sensor_);
    const int label = scan.primitives_in_body.labels[i];
    const int landmark = label < 0 ? -1 : landmark_of_plane[static_cast<std::size_t>(label)];
    for (LocalLevel& level : levels_) level.surfaces.insert(point, normal, variance, landmark);
  }
  const Rims& rims = scan.rims_in_body;
  for (std::size_t i = 0; i < rims.size(); ++i) {
    const Eigen::Vector3f point = pose * rims.points[i];
    const Eigen::Vector3f normal = pose.linear() * rims.normals[i];
    const float variance = rims.sigmas[i] * rims.sigmas[i];
    for (LocalLevel& level : levels_) level.rims.insert(point, normal, variance, -1);
  }
}

void LocalMap::setLandmarks(std::vector<Plane> planes_in_map) {
  landmark_planes_ = std::move(planes_in_map);
  double sum = 0.0, count = 0.0;
  fine().surfaces.forEach([&](const Surfel& surfel) {
    if (surfel.landmark < 0) return;
    const Eigen::Vector3d& normal =
        landmark_planes_[static_cast<std::size_t>(surfel.landmark)].normal();
    sum += 0.5 * surfel.normal.cast<double>().cross(normal).squaredNorm();
    count += 1.0;
  });
  if (count > 0.0) normal_variance_ = sum / count;
}

}  // namespace opp::mapping
