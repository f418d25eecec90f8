// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/geometry/plane.h"
#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/registration/registration_params.h"
#include "opp/mapping/registration/surfel_map.h"

#include <vector>

namespace opp::mapping {

/// What scans saw at one resolution.
struct LocalLevel {
  SurfelMap surfaces;
  SurfelMap rims;  ///< as surfels that face across the rim

  double voxelSize() const { return surfaces.voxelSize(); }
};

/// What a scan is registered against: surfels and rims of some keyframes at several resolutions and
/// the plane landmarks.
class LocalMap {
 public:
  /// An empty map for samples about `spacing` [m] apart.
  LocalMap(double spacing, const SensorModel& sensor, const RegistrationParams& params);

  /// Adds the samples and rims of a scan. `landmark_of_plane[p]` is the landmark of scan plane p
  /// (−1: none).
  void insert(const ScanFeatures& scan, const Eigen::Isometry3d& map_from_body,
              const std::vector<int>& landmark_of_plane);
  /// Replaces the landmarks' planes; index = landmark id. All that were inserted need one.
  void setLandmarks(std::vector<Plane> planes_in_map);

  /// Noise of the scans, and their distortion as far as the map shows it.
  const SensorModel& sensor() const { return sensor_; }
  const LocalLevel& fine() const { return levels_.front(); }
  /// Fine to coarse, at least one.
  const std::vector<LocalLevel>& levels() const { return levels_; }
  const std::vector<Plane>& landmarkPlanes() const { return landmark_planes_; }
  /// Variance of the fine surfels' normals about either tangent [rad²], from how those on landmarks
  /// scatter; without landmarks what RegistrationParams assume.
  double normalVariance() const { return normal_variance_; }

 private:
  SensorModel sensor_;
  std::vector<LocalLevel> levels_;
  std::vector<Plane> landmark_planes_;
  double normal_variance_;
};

}  // namespace opp::mapping
