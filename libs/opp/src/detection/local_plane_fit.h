// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include <Eigen/Core>

namespace opp {

/// Least squares of heights over a plane that is nearly right already: h ≈ a u + b v + c with
/// (u, v, h) the coordinates of a point in the plane's frame. A closed form, several times faster
/// than an eigenvalue problem; voting fits some thousand planes a scan.
class LocalPlaneFit {
 public:
  /// `normal` has unit length; `origin` lies near the points.
  LocalPlaneFit(const Eigen::Vector3d& normal, const Eigen::Vector3d& origin)
      : origin_(origin), normal_(normal), tangents_(tangentBasis(normal)) {}

  void add(const Eigen::Vector3d& x, double weight) {
    const Eigen::Vector3d delta = x - origin_;
    const Eigen::Vector2d uv = tangents_.transpose() * delta;
    const double h = normal_.dot(delta);
    weight_ += weight;
    sum_uv_ += weight * uv;
    sum_uvuv_ += weight * uv * uv.transpose();
    sum_uvh_ += weight * h * uv;
    sum_h_ += weight * h;
    ++count_;
  }

  int count() const { return count_; }
  /// Mean of the points.
  Eigen::Vector3d mean() const {
    return origin_ + (tangents_ * sum_uv_ + sum_h_ * normal_) / weight_;
  }
  /// The plane through mean(). `slope_information` pulls its slope to zero where the points do not
  /// fix it (collinear points) [m² × weight]. Needs at least one point.
  Plane plane(double slope_information) const {
    const Eigen::Vector2d mean_uv = sum_uv_ / weight_;
    Eigen::Matrix2d a = sum_uvuv_ - weight_ * mean_uv * mean_uv.transpose();
    a.diagonal().array() += slope_information;
    const Eigen::Vector2d b = sum_uvh_ - sum_h_ * mean_uv;
    const double determinant = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
    const Eigen::Vector2d slope((a(1, 1) * b[0] - a(0, 1) * b[1]) / determinant,
                                (a(0, 0) * b[1] - a(1, 0) * b[0]) / determinant);
    return Plane::fromPointNormal(mean(), normal_ - tangents_ * slope);
  }

 private:
  Eigen::Vector3d origin_, normal_;
  Eigen::Matrix<double, 3, 2> tangents_;
  double weight_ = 0.0, sum_h_ = 0.0;
  Eigen::Vector2d sum_uv_ = Eigen::Vector2d::Zero(), sum_uvh_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d sum_uvuv_ = Eigen::Matrix2d::Zero();
  int count_ = 0;
};

}  // namespace opp
