// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planar/landmark_covariance.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// What a view tells of (α, β, δ) in spite of distortion.
Eigen::Matrix3d informationOf(const PointMoments& moments, double range,
                              const Eigen::Matrix<double, 3, 2>& tangents,
                              const SensorModel& sensor) {
  const double bend = sensor.distortion(range), slope = sensor.distortionSlope(range);
  const double length = bend / slope;  // within which distortion is one error [m]
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(
      tangents.transpose() * moments.scatter() * tangents / moments.weight());
  // An even patch is √12 standard deviations wide. So many lengths side by side err apart.
  const Eigen::Array2d parts =
      (12.0 * spread.eigenvalues().array().max(0.0)).sqrt().max(length) / length;
  Eigen::Vector3d offset;
  offset << tangents.transpose() * moments.mean(), 1.0;
  Eigen::Matrix3d information = offset * offset.transpose() * parts.prod() / (bend * bend);
  for (int k = 0; k < 2; ++k) {
    // Of a line through n values of deviation b, spread evenly over n lengths: b √(12 / n³).
    const double tilt = slope * slope * std::min(1.0, 12.0 / std::pow(parts[k], 3)) / parts[1 - k];
    const Eigen::Vector2d axis = spread.eigenvectors().col(k);
    information.topLeftCorner<2, 2>() += axis * axis.transpose() / tilt;
  }
  return information;
}

}  // namespace

Eigen::Matrix3d landmarkCovariance(const PlaneLandmark& landmark, const MapState& map,
                                   const SensorModel& sensor) {
  const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(landmark.plane_in_map.normal());
  PointMoments all;
  Eigen::Matrix3d despite_distortion = Eigen::Matrix3d::Zero();
  for (const PrimitiveObservation& observation : landmark.observations) {
    const Keyframe& keyframe = map.keyframes[Index(observation.keyframe)];
    const PointMoments& seen =
        keyframe.features.primitives_in_body.planes[Index(observation.primitive)].moments;
    if (seen.empty()) continue;
    const PointMoments in_map = transformed(keyframe.map_from_body, seen);
    all.merge(in_map);
    const double range =
        (seen.mean() - keyframe.features.cloud_in_body.viewpoint.cast<double>()).norm();
    if (sensor.distortion(range) > 0.0)
      despite_distortion += informationOf(in_map, range, tangents, sensor);
  }
  Eigen::Matrix3d covariance = planeCovariance(landmark.plane_in_map, all);
  if (!despite_distortion.isZero()) covariance += despite_distortion.inverse();
  return covariance;
}

double positionDeviation(const Eigen::Vector3d& point, const Plane& plane,
                         const Eigen::Matrix3d& covariance) {
  Eigen::Vector3d change;
  change << tangentBasis(plane.normal()).transpose() * point, 1.0;
  return std::sqrt(std::max(0.0, change.dot(covariance * change)));
}

}  // namespace opp::mapping
