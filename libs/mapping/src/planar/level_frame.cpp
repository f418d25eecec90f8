// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/planar/level_frame.h"

#include <cmath>

namespace opp::mapping {
namespace {

/// Planes whose normals are within 6° of the horizontal count as plumb here.
constexpr double kPlumb = 0.1;

/// Angle about `up` of the planes' normals, in a quarter turn: mean weighted by area of the angle
/// times four, which walls at right angles share.
double wallAngle(const PlanarMap& map, const Eigen::Matrix3d& level_from_map) {
  double sine = 0.0, cosine = 0.0;
  for (const PlanarMapPlane& plane : map.planes) {
    const Eigen::Vector3d normal = level_from_map * plane.plane.normal();
    if (std::abs(normal.z()) > kPlumb) continue;
    const double angle = 4.0 * std::atan2(normal.y(), normal.x());
    sine += plane.area * std::sin(angle);
    cosine += plane.area * std::cos(angle);
  }
  return sine == 0.0 && cosine == 0.0 ? 0.0 : std::atan2(sine, cosine) / 4.0;
}

}  // namespace

Eigen::Isometry3d levelFromMap(const PlanarMap& map, const Eigen::Vector3d& up) {
  const Eigen::Matrix3d upright =
      Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Isometry3d level_from_map = Eigen::Isometry3d::Identity();
  level_from_map.linear() =
      Eigen::AngleAxisd(-wallAngle(map, upright), Eigen::Vector3d::UnitZ()).toRotationMatrix() *
      upright;
  return level_from_map;
}

}  // namespace opp::mapping
