// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/registration/alignment_input.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// Range of the nearest surface in each direction from a view, on the six faces of a cube: tells
/// whether the view looked through a place. Conservative: a sample covers all directions within its
/// share of the surface, and the nearest one counts.
class DepthMap {
 public:
  explicit DepthMap(const OrientedCloud& cloud);

  /// Range at which the line of sight through `point` first meets a surface [m]; 0 where none was
  /// seen. Constant time.
  float range(const Eigen::Vector3f& point) const;

  /// How much nearer than `range` a place has to be that the view surely looked through [m].
  float margin(float range) const;

  const Eigen::Vector3f& viewpoint() const { return viewpoint_; }

 private:
  void cover(const Eigen::Vector3f& ray, float angular_radius);

  Eigen::Vector3f viewpoint_;
  double spacing_;
  std::vector<float> ranges_;
};

/// What the views of a scan looked through.
class FreeSpace {
 public:
  explicit FreeSpace(const std::vector<ScanView>& views);

  /// Did a view look through a surface that stands at `point` (frame of the features)?
  /// \param slack how far from its true place the surface may be [m]
  bool contains(const Eigen::Vector3f& point, float slack) const;

 private:
  struct View {
    Eigen::Isometry3f view_from_features;
    DepthMap depth;
  };
  std::vector<View> views_;
};

}  // namespace opp::mapping
