// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_mask.h"
#include "plane_coordinates.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

namespace opp::mapping {

/// Counts the pixels on one side of a face in square cells. Cells of coplanar sides coincide.
class Coverage {
 public:
  Coverage(const Face& face, const Plane& side_plane, double cell);

  /// Counts a pixel at a point of the plane; points outside of the face's rectangle count into its
  /// nearest cell.
  void add(const Eigen::Vector3d& point);
  std::uint64_t total() const { return total_; }
  /// Whether a cell within `radius` cells of the point's was seen, diagonally, too.
  bool seenNear(const Eigen::Vector3d& point, int radius) const;
  /// Calls `visit(centre, pixels)` for each seen cell, row by row.
  void forEachSeen(const std::function<void(const Eigen::Vector3d&, std::uint32_t)>& visit) const;
  Eigen::Vector2i firstCell() const { return first_; }  ///< of the raster's rectangle
  Eigen::Vector2i lastCell() const { return first_ + size_ - Eigen::Vector2i::Ones(); }
  /// Adds the seen cells to a set that includes the raster's rectangle.
  void addTo(CellMask& mask) const;
  const PlaneCoordinates& coordinates() const { return coordinates_; }

 private:
  Eigen::Vector2i cellOf(const Eigen::Vector3d& point) const;  ///< relative to first_
  std::uint32_t count(int u, int v) const;

  PlaneCoordinates coordinates_;
  double cell_;
  Eigen::Vector2i first_;  ///< cell number of the grid's corner; cell (0, 0) begins at uv = 0
  Eigen::Vector2i size_;
  std::vector<std::uint32_t> counts_;
  std::uint64_t total_ = 0;
};

}  // namespace opp::mapping
