// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <mrpt/img/TCamera.h>

#include <list>
#include <memory>
#include <vector>

namespace opp::mapping {

/// For each pixel (row * ncols + col) of a depth camera the direction (1, y, z) of its ray in the
/// sensor's frame (x forward, y left, z up), so that depth · ray is the point. NaN for pixels that
/// the lens model does not reach. \throws std::runtime_error if a focal length is zero.
std::vector<Eigen::Vector3f> pixelRays(const mrpt::img::TCamera& camera);

/// Image coordinates (x right, y down, at depth 1) of the ray whose distorted image is
/// `distorted`; NaN if there is none.
Eigen::Vector2d undistort(const mrpt::img::TCamera& camera, const Eigen::Vector2d& distorted);

/// The lens model: where the ray (x, y, 1) appears, at depth 1.
Eigen::Vector2d distort(const mrpt::img::TCamera& camera, const Eigen::Vector2d& ideal);

/// Ray tables of the cameras in use; a table costs tens of milliseconds, so it is kept.
class PixelRayCache {
 public:
  using Rays = std::shared_ptr<const std::vector<Eigen::Vector3f>>;
  Rays raysOf(const mrpt::img::TCamera& camera);

 private:
  struct Entry {
    mrpt::img::TCamera camera;
    Rays rays;
  };
  std::list<Entry> entries_;  ///< most recently used first
};

}  // namespace opp::mapping
