// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace opp::mapping {

/// Square cell of a raster on a plane: [column, column + 1) × [row, row + 1) cells from the frame's
/// origin.
struct PlaneCell {
  std::int32_t row = 0;
  std::int32_t column = 0;
  friend bool operator==(const PlaneCell& a, const PlaneCell& b) {
    return a.row == b.row && a.column == b.column;
  }
  friend bool operator<(const PlaneCell& a, const PlaneCell& b) {
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  }
};

/// Coordinates of a cell's centre, in cells.
inline Eigen::Vector2d centreOf(const PlaneCell& cell) {
  return {cell.column + 0.5, cell.row + 0.5};
}

/// Right-handed coordinates (u, v) on a plane; seen from the normal's side u × v turns
/// counter-clockwise.
class PlaneFrame {
 public:
  /// u runs along the part of `u_hint` within the plane; any direction if there is none. A hint
  /// along the edges of what lies on the plane gives the raster straight outlines.
  PlaneFrame(const Plane& plane, const Eigen::Vector3d& u_hint);

  const Plane& plane() const { return plane_; }
  const Eigen::Vector3d& uAxis() const { return u_axis_; }
  /// Coordinates of the point's projection on the plane [m].
  Eigen::Vector2d project(const Eigen::Vector3d& point) const {
    return {u_axis_.dot(point), v_axis_.dot(point)};
  }
  /// Cell of edge `cell` [m] with the point's projection.
  PlaneCell cellAt(const Eigen::Vector3d& point, double cell) const;
  /// The point of the plane with these coordinates.
  Eigen::Vector3d lift(const Eigen::Vector2d& uv) const {
    return uv.x() * u_axis_ + uv.y() * v_axis_ - plane_.d() * plane_.normal();
  }

 private:
  Plane plane_;
  Eigen::Vector3d u_axis_;
  Eigen::Vector3d v_axis_;
};

/// Where a plane was seen and where rays passed through it, over any number of scans. What is added
/// in which order makes no difference.
class PlaneExtent {
 public:
  /// `cell`: edge of a raster cell [m]. \throws std::invalid_argument unless it is positive.
  PlaneExtent(const PlaneFrame& frame, double cell);

  /// A sample on the plane, which stands for a square of edge `footprint` [m] around it.
  void addSupport(const Eigen::Vector3d& point, double footprint);

  /// A ray from `viewpoint` to a sample at `point` that stands for `footprint` there. Nothing
  /// happens unless it crosses the plane and ends more than `clearance` [m] behind it.
  void addSightline(const Eigen::Vector3d& viewpoint, const Eigen::Vector3d& point,
                    double footprint, double clearance);

  const PlaneFrame& frame() const { return frame_; }
  double cell() const { return cell_; }
  /// Cells with support, and cells without support that a ray passed through: ascending, unique.
  std::vector<PlaneCell> supportCells() const;
  std::vector<PlaneCell> openCells() const;

 private:
  void mark(const Eigen::Vector2d& center, double footprint, std::vector<PlaneCell>& cells) const;

  PlaneFrame frame_;
  double cell_;
  mutable std::vector<PlaneCell> support_;  ///< with repetitions until asked for
  mutable std::vector<PlaneCell> passed_;
};

}  // namespace opp::mapping
