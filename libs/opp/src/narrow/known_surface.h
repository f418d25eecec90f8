// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include "cloud/point_noise.h"

#include <Eigen/Geometry>

#include <cmath>

namespace opp {

/// A plane that was found, and where it can be; all about the viewpoint.
class KnownSurface {
 public:
  KnownSurface(const Plane& plane_about_viewpoint, const Eigen::AlignedBox3f& reach,
               const PointNoise& noise)
      : normal_(plane_about_viewpoint.normal().cast<float>()),
        height_(static_cast<float>(-plane_about_viewpoint.d())),
        reach_(reach),
        noise_(noise.onPlane(plane_about_viewpoint.d() * plane_about_viewpoint.d())) {}

  const Eigen::Vector3f& normal() const { return normal_; }
  double height() const { return static_cast<double>(height_); }
  const PointNoise::OnPlane& noise() const { return noise_; }
  const Eigen::AlignedBox3f& reach() const { return reach_; }
  bool reaches(const Eigen::Vector3f& point) const { return reach_.contains(point); }
  double offset(const Eigen::Vector3f& point) const {
    return static_cast<double>(normal_.dot(point) - height_);
  }
  /// Of the offset of a pixel that shows it [m²].
  double variance(double squared_range) const { return noise_.variance(squared_range); }
  /// Squared offset over its variance.
  double misfit(const Eigen::Vector3f& point) const {
    const double off = offset(point);
    return off * off / variance(static_cast<double>(point.squaredNorm()));
  }

  /// Whether points in a box, or `margin` [m] beside it, as far as `range` [m] may be within so
  /// many standard deviations of it.
  bool isNear(const Eigen::AlignedBox3f& box, double range, double margin, double sigmas) const {
    const Eigen::Vector3f half = 0.5F * box.sizes();
    const auto reach = static_cast<double>(normal_.cwiseAbs().dot(half));
    const double noise = sigmas * std::sqrt(variance(range * range));
    return std::abs(offset(box.center())) <= reach + margin + noise;
  }

 private:
  Eigen::Vector3f normal_;
  float height_;  ///< n·x of its points [m]
  Eigen::AlignedBox3f reach_;
  PointNoise::OnPlane noise_;
};

}  // namespace opp
