// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/local_map.h"

#include "opp/mapping/registration/plane_samples.h"

namespace opp::mapping {

LocalMap::LocalMap(double spacing, const SensorModel& sensor, const RegistrationParams& params)
    : sensor_(sensor) {
  double voxel_size = params.surfel_size_ratio * spacing;
  for (int level = 0; level < params.levels; ++level, voxel_size *= params.level_ratio) {
    levels_.emplace_back(voxel_size, params.normal_gate);
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
    for (SurfelMap& level : levels_) level.insert(point, normal, variance, landmark);
  }
}

}  // namespace opp::mapping
