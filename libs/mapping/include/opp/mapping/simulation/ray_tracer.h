// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/simulation/world.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace opp::mapping {

/// What a ray meets first.
struct RayHit {
  int side = -1;          ///< side of the world's face (see World); −1: nothing
  double distance = 0.0;  ///< in units of the direction's length
  bool valid() const { return side >= 0; }
};

/// Finds what rays meet in a world. Embree (float32) finds the face; the distance is that of the
/// face's plane, intersected in double, so that a hit is on its plane to rounding (1e-15 of the
/// coordinates). Near a face's border the choice of face may be off by float32 rounding, about
/// 1e-6 m at 10 m. Const functions may be called from several threads.
class RayTracer {
 public:
  /// Keeps a copy of the planes; O(faces · log faces).
  /// \throws std::runtime_error if a face cannot be triangulated or Embree fails.
  explicit RayTracer(const World& world);
  ~RayTracer();
  RayTracer(RayTracer&&) noexcept;
  RayTracer& operator=(RayTracer&&) noexcept;

  /// First hit of origin + t · direction, t > 0, of either side of a face.
  RayHit trace(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  /// trace() for each direction; faster by a factor of 2 to 3 where neighbours in the list are
  /// neighbours in space.
  std::vector<RayHit> trace(const Eigen::Vector3d& origin,
                            const std::vector<Eigen::Vector3d>& directions) const;
  /// For each point of `to` whether something lies between it and `from`, the last `slack` [m]
  /// before the point excepted.
  std::vector<bool> blocked(const Eigen::Vector3d& from, const std::vector<Eigen::Vector3d>& to,
                            double slack = 1e-3) const;
  /// Normal of a side, toward where it is seen from.
  Eigen::Vector3d sideNormal(int side) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace opp::mapping
