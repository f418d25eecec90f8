// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud/depth_image.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// Mean of the open pixels of 2 × 2.
struct PixelCell {
  static constexpr int kEdge = 2;                   ///< in pixels
  Eigen::Vector3f point = Eigen::Vector3f::Zero();  ///< about the viewpoint [m]
  float range = 0.0F;
  int count = 0;  ///< of pixels
  int row = 0, col = 0;
};

/// Cells with two and more open pixels that do not lie astride of a jump in range.
class PixelCells {
 public:
  PixelCells(const DepthImage& image, const std::vector<std::uint8_t>& open);

  int size() const { return static_cast<int>(cells_.size()); }
  const PixelCell& operator[](int index) const { return cells_[static_cast<std::size_t>(index)]; }
  int rows() const { return rows_; }
  int cols() const { return cols_; }
  /// Negative: no cell.
  int indexAt(int row, int col) const { return at_[static_cast<std::size_t>(row * cols_ + col)]; }
  /// visit(index) for the cells in a square around a cell, itself included.
  template <typename Visit>
  void visitAround(const PixelCell& cell, int radius, const Visit& visit) const {
    const int bottom = std::min(rows_ - 1, cell.row + radius);
    const int right = std::min(cols_ - 1, cell.col + radius);
    for (int r = std::max(0, cell.row - radius); r <= bottom; ++r) {
      for (int c = std::max(0, cell.col - radius); c <= right; ++c) {
        const int index = indexAt(r, c);
        if (index >= 0) visit(index);
      }
    }
  }

 private:
  int rows_, cols_;  ///< of the grid of cells
  std::vector<PixelCell> cells_;
  static constexpr int kNone = -1, kUnseen = -2;
  std::vector<int> at_;  ///< [row * cols + col]: index into cells_; negative: no cell
};

}  // namespace opp
