// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/geometry/point_cloud.h"

#include "cloud/grid_patches.h"
#include "cloud/patch_normals.h"
#include "cloud/point_noise.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace opp {

/// Mean of the points in a cell of the grid, half as wide and high as a block.
struct OpenCell {
  Eigen::Vector3d point;       ///< from the viewpoint [m]
  double count = 0.0;          ///< of raw points
  double squared_range = 0.0;  ///< [m²]
  int row = 0, col = 0;        ///< of cells
  int block = 0;
};

/// Cells of an organized cloud that no surface with known normals around them explains.
struct OpenCells {
  std::vector<OpenCell> cells;
  int rows = 0, cols = 0;  ///< of the grid of cells
  std::vector<int> at;     ///< [row * cols + col]: index into cells; −1: not open

  const OpenCell& operator[](int index) const { return cells[static_cast<std::size_t>(index)]; }
  /// visit(index) for the open cells among a cell and its eight neighbours.
  template <typename Visit>
  void visitAround(const OpenCell& cell, const Visit& visit) const {
    for (int r = std::max(0, cell.row - 1); r <= std::min(rows - 1, cell.row + 1); ++r) {
      for (int c = std::max(0, cell.col - 1); c <= std::min(cols - 1, cell.col + 1); ++c) {
        const int index = at[static_cast<std::size_t>(r * cols + c)];
        if (index >= 0) visit(index);
      }
    }
  }
};

/// Variance of the mean of a cell's points about a surface through it with this normal [m²].
inline double varianceOf(const OpenCell& cell, const Eigen::Vector3d& normal,
                         const PointNoise& noise) {
  return noise.expected(cell.squared_range, normal.dot(cell.point)) / cell.count;
}

/// The cells of patches without a normal (one entry of `normals` per patch; zero: none) that lie on
/// none of the planes of the patches up to two blocks away, nor astride of a jump in range. Normals
/// of these within three standard deviations of one of `directions` are taken for it, and patches
/// on one plane for one plane. O(points + open blocks).
OpenCells openCells(const PointCloud& cloud, const GridPatches& grid,
                    const std::vector<PatchNormal>& normals,
                    const std::vector<Eigen::Vector3d>& directions, const SensorModel& sensor,
                    const PointNoise& noise);

}  // namespace opp
