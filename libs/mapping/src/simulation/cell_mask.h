// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planar/geos.h"

#include <Eigen/Core>

#include <vector>

namespace opp::mapping {

/// Set of square cells in a rectangle of the plane; cell (0, 0) begins at the origin.
class CellMask {
 public:
  /// Empty set within the cells `low` to `high`, both included.
  CellMask(const Eigen::Vector2i& low, const Eigen::Vector2i& high);

  void insert(const Eigen::Vector2i& cell);  ///< must lie in the rectangle
  bool contains(const Eigen::Vector2i& cell) const;
  /// Fills gaps of up to 2 · radius cells (dilation, then erosion, by a square).
  CellMask closed(int radius) const;
  /// The cells as rectangles, one for each run of a row. \param cell side of a cell [m].
  std::vector<Polygon2d> runs(double cell) const;

 private:
  /// Cells of which a neighbour within `radius` along an axis is (`any`), or all are, in the set.
  CellMask filtered(int radius, int axis, bool any) const;

  Eigen::Vector2i low_;
  Eigen::Vector2i size_;
  std::vector<char> cells_;
};

}  // namespace opp::mapping
