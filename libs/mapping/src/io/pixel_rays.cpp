// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "io/pixel_rays.h"

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// More cameras than any rig has; a table of VGA size takes 3.7 MB.
constexpr std::size_t kMaxCameras = 8;
/// Newton's method doubles its digits in each step; far fewer are needed inside of the lens model.
constexpr int kMaxIterations = 50;
/// Residual of an inverted distortion, at depth 1: far below a pixel (about 2e-3).
constexpr double kTolerance = 1e-10;

const Eigen::Vector2d kUnreachable =
    Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

/// Rational radial and tangential distortion, as OpenCV defines it.
Eigen::Vector2d plumbBob(const mrpt::img::TCamera& camera, const Eigen::Vector2d& p) {
  const auto& d = camera.dist;  // k1 k2 p1 p2 k3 k4 k5 k6
  const double r2 = p.squaredNorm();
  const double radial =
      (1.0 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]))) / (1.0 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
  const double xy = p.x() * p.y();
  return {p.x() * radial + 2.0 * d[2] * xy + d[3] * (r2 + 2.0 * p.x() * p.x()),
          p.y() * radial + d[2] * (r2 + 2.0 * p.y() * p.y()) + 2.0 * d[3] * xy};
}

/// Equidistant fish-eye: the image radius is a polynomial of the ray's angle.
Eigen::Vector2d kannalaBrandt(const mrpt::img::TCamera& camera, const Eigen::Vector2d& p) {
  const auto& d = camera.dist;  // k1 k2 * * k3 k4
  const double radius = p.norm();
  if (radius == 0.0) return p;
  const double angle = std::atan(radius);
  const double a2 = angle * angle;
  const double image_radius = angle * (1.0 + a2 * (d[0] + a2 * (d[1] + a2 * (d[4] + a2 * d[5]))));
  return p * (image_radius / radius);
}

bool sameModel(const mrpt::img::TCamera& a, const mrpt::img::TCamera& b) {
  return a.ncols == b.ncols && a.nrows == b.nrows && a.intrinsicParams == b.intrinsicParams &&
         a.distortion == b.distortion && a.dist == b.dist;
}

}  // namespace

Eigen::Vector2d distort(const mrpt::img::TCamera& camera, const Eigen::Vector2d& ideal) {
  switch (camera.distortion) {
    case mrpt::img::DistortionModel::plumb_bob:
      return plumbBob(camera, ideal);
    case mrpt::img::DistortionModel::kannala_brandt:
      return kannalaBrandt(camera, ideal);
    default:
      return ideal;
  }
}

Eigen::Vector2d undistort(const mrpt::img::TCamera& camera, const Eigen::Vector2d& distorted) {
  Eigen::Vector2d p = distorted;
  for (int k = 0; k < kMaxIterations; ++k) {
    const Eigen::Vector2d residual = distort(camera, p) - distorted;
    if (residual.norm() < kTolerance) return p;
    // Central differences: at a step of 1e-6 both their errors are below 1e-9.
    constexpr double kStep = 1e-6;
    Eigen::Matrix2d jacobian;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
      jacobian.col(axis) = (distort(camera, p + step) - distort(camera, p - step)) / (2 * kStep);
    }
    // Beyond the fold of the model the determinant changes its sign: no ray is seen there.
    if (!(jacobian.determinant() > 0.0)) return kUnreachable;
    p -= jacobian.inverse() * residual;
  }
  return kUnreachable;
}

std::vector<Eigen::Vector3f> pixelRays(const mrpt::img::TCamera& camera) {
  if (!(std::abs(camera.fx()) > 0.0) || !(std::abs(camera.fy()) > 0.0)) {
    throw std::runtime_error("the depth camera has no focal length");
  }
  std::vector<Eigen::Vector3f> rays;
  rays.reserve(std::size_t{camera.ncols} * camera.nrows);
  for (uint32_t row = 0; row < camera.nrows; ++row) {
    for (uint32_t col = 0; col < camera.ncols; ++col) {
      const Eigen::Vector2d image((col - camera.cx()) / camera.fx(),
                                  (row - camera.cy()) / camera.fy());
      const Eigen::Vector2d ideal = undistort(camera, image);
      rays.push_back(Eigen::Vector3d(1.0, -ideal.x(), -ideal.y()).cast<float>());
    }
  }
  return rays;
}

PixelRayCache::Rays PixelRayCache::raysOf(const mrpt::img::TCamera& camera) {
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    if (!sameModel(entry->camera, camera)) continue;
    entries_.splice(entries_.begin(), entries_, entry);
    return entries_.front().rays;
  }
  entries_.push_front(
      {camera, std::make_shared<const std::vector<Eigen::Vector3f>>(pixelRays(camera))});
  if (entries_.size() > kMaxCameras) entries_.pop_back();
  return entries_.front().rays;
}

}  // namespace opp::mapping
