// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/core/se3.h"

namespace opp::mapping {
namespace {

Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const double sine = q.vec().norm();
  // Near zero, 2·atan2(s, w)/s tends to 2/w.
  const double scale = sine > 1e-9 ? 2.0 * std::atan2(sine, q.w()) / sine : 2.0 / q.w();
  return scale * q.vec();
}

Eigen::Matrix3d rotationFromVector(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  if (angle < 1e-300) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, omega / angle).toRotationMatrix();
}

}  // namespace

Eigen::Isometry3d retract(const Eigen::Isometry3d& a_from_b, const Vector6d& omega_v) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = rotationFromVector(omega_v.head<3>()) * a_from_b.linear();
  result.translation() = a_from_b.translation() + omega_v.tail<3>();
  return normalized(result);
}

Vector6d difference(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  Vector6d omega_v;
  omega_v << rotationVector(to.linear() * from.linear().transpose()),
      to.translation() - from.translation();
  return omega_v;
}

Eigen::Isometry3d normalized(const Eigen::Isometry3d& pose) {
  Eigen::Isometry3d result = pose;
  result.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return result;
}

double rotationAngle(const Eigen::Isometry3d& pose) { return rotationVector(pose.linear()).norm(); }

}  // namespace opp::mapping
