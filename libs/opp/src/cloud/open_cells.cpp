// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/open_cells.h"

#include "opp/geometry/constants.h"

#include <algorithm>
#include <cmath>

namespace opp {
namespace {

/// Blocks up to this far tell which surfaces end at an open one.
constexpr int kReach = 2;
/// Normals that differ less from a main direction are taken for it.
constexpr double kSnapAngle = degToRad(12.0);
/// A cell this near to a surface needs no other explanation.
constexpr double kExplainedSigmas = 2.0;
constexpr double kSamePlaneSigmas = 3.0;

/// Points of a cell lie on one surface if their ranges differ by no more than noise and a surface
/// seen at 80° make them; else their mean hangs between two surfaces.
constexpr double kJumpSigmas = 3.0;
constexpr double kSteepest = 5.7;  // tan 80°

/// A plane of some patches, about the viewpoint.
struct SurfaceAround {
  Eigen::Vector3d normal;
  double height = 0.0;    ///< n·x of its points [m]
  double variance = 0.0;  ///< of the height of one patch [m²]
  double count = 0.0;     ///< of raw points
  int direction = -1;     ///< index; −1: none of them
};

class OpenCellGatherer {
 public:
  OpenCellGatherer(const PointCloud& cloud, const GridPatches& grid,
                   const std::vector<PatchNormal>& normals,
                   const std::vector<Eigen::Vector3d>& directions, const SensorModel& sensor,
                   const PointNoise& noise)
      : cloud_(cloud),
        grid_(grid),
        normals_(normals),
        directions_(directions),
        least_(static_cast<float>(sensor.min_range * sensor.min_range)),
        most_(static_cast<float>(sensor.max_range * sensor.max_range)),
        noise_(noise),
        cell_rows_(grid.cellRows()),
        cell_cols_(grid.cellCols()),
        surface_of_patch_(normals.size(), -1) {
    result_.rows = (cloud.rows + cell_rows_ - 1) / cell_rows_;
    result_.cols = (cloud.cols + cell_cols_ - 1) / cell_cols_;
    result_.at.assign(
        static_cast<std::size_t>(result_.rows) * static_cast<std::size_t>(result_.cols), -1);
  }

  OpenCells gather() {
    for (std::size_t patch = 0; patch < normals_.size(); ++patch) {
      if (normals_[patch].normal.isZero()) visitBlock(grid_.block_of_patch[patch]);
    }
    return std::move(result_);
  }

 private:
  void visitBlock(int block) {
    findSurfaces(block / grid_.cols, block % grid_.cols);
    const int top = block / grid_.cols * grid_.block_rows;
    const int left = block % grid_.cols * grid_.block_cols;
    for (int row = top; row < std::min(cloud_.rows, top + grid_.block_rows); row += cell_rows_) {
      for (int col = left; col < std::min(cloud_.cols, left + grid_.block_cols);
           col += cell_cols_) {
        OpenCell cell = cellAt(row, col);
        if (cell.count == 0.0 || explained(cell)) continue;
        cell.block = block;
        result_.at[static_cast<std::size_t>(cell.row * result_.cols + cell.col)] =
            static_cast<int>(result_.cells.size());
        result_.cells.push_back(cell);
      }
    }
  }

  OpenCell cellAt(int row, int col) const {
    OpenCell cell;
    cell.row = row / cell_rows_, cell.col = col / cell_cols_;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float nearest = most_, farthest = 0.0F;
    for (int r = row; r < std::min(cloud_.rows, row + cell_rows_); ++r) {
      for (int c = col; c < std::min(cloud_.cols, col + cell_cols_); ++c) {
        const Eigen::Vector3f point =
            cloud_.points[static_cast<std::size_t>(r * cloud_.cols + c)] - cloud_.viewpoint;
        const float squared_range = point.squaredNorm();
        // Points that are not finite compare false.
        if (!(squared_range >= least_ && squared_range <= most_)) continue;
        sum += point;
        cell.count += 1.0;
        nearest = std::min(nearest, squared_range);
        farthest = std::max(farthest, squared_range);
      }
    }
    cell.point = sum.cast<double>() / std::max(1.0, cell.count);
    cell.squared_range = cell.point.squaredNorm();
    if (jumps(static_cast<double>(nearest), static_cast<double>(farthest))) cell.count = 0.0;
    return cell;
  }

  bool jumps(double squared_nearest, double squared_farthest) const {
    const double near = std::sqrt(squared_nearest), far = std::sqrt(squared_farthest);
    const double noise = 2.0 * noise_.expected(squared_farthest, far);  // of a difference
    const double slope = kSteepest * grid_.patches.pixel_angle * far;
    return far - near > kJumpSigmas * std::sqrt(noise) + slope;
  }

  bool explained(const OpenCell& cell) const {
    return std::any_of(surfaces_.begin(), surfaces_.end(), [&](const SurfaceAround& surface) {
      const double offset = surface.normal.dot(cell.point) - surface.height;
      return offset * offset <=
             kExplainedSigmas * kExplainedSigmas * varianceOf(cell, surface.normal, noise_);
    });
  }

  void findSurfaces(int row, int col) {
    surfaces_.clear();
    for (int r = std::max(0, row - kReach); r <= std::min(grid_.rows - 1, row + kReach); ++r) {
      for (int c = std::max(0, col - kReach); c <= std::min(grid_.cols - 1, col + kReach); ++c) {
        const int patch = grid_.patch_of_block[static_cast<std::size_t>(r * grid_.cols + c)];
        if (patch < 0 || normals_[static_cast<std::size_t>(patch)].normal.isZero()) continue;
        addSurface(surfaceOf(static_cast<std::size_t>(patch)));
      }
    }
  }

  void addSurface(const SurfaceAround& surface) {
    for (SurfaceAround& known : surfaces_) {
      if (surface.direction < 0 || known.direction != surface.direction) continue;
      const double offset = known.height - surface.height;
      const double variance = known.variance + surface.variance;
      if (offset * offset > kSamePlaneSigmas * kSamePlaneSigmas * variance) continue;
      known.count += surface.count;
      known.height -= offset * surface.count / known.count;
      return;
    }
    surfaces_.push_back(surface);
  }

  /// Computed once, as up to 25 blocks ask for it.
  const SurfaceAround& surfaceOf(std::size_t patch) {
    int& index = surface_of_patch_[patch];
    if (index < 0) {
      index = static_cast<int>(patch_surfaces_.size());
      OpenCell mean;
      mean.point =
          grid_.patches.means[patch] + grid_.patches.origin - cloud_.viewpoint.cast<double>();
      mean.squared_range = mean.point.squaredNorm();
      mean.count = grid_.patches.sums[patch][0];
      SurfaceAround surface = snapped(normals_[patch].normal);
      surface.height = surface.normal.dot(mean.point);
      surface.variance = varianceOf(mean, surface.normal, noise_);
      surface.count = mean.count;
      patch_surfaces_.push_back(surface);
    }
    return patch_surfaces_[static_cast<std::size_t>(index)];
  }

  SurfaceAround snapped(const Eigen::Vector3d& normal) const {
    static const double kLeastCosine = std::cos(kSnapAngle);
    for (std::size_t k = 0; k < directions_.size(); ++k) {
      if (std::abs(directions_[k].dot(normal)) < kLeastCosine) continue;
      return {directions_[k], 0.0, 0.0, 0.0, static_cast<int>(k)};
    }
    return {normal, 0.0, 0.0, 0.0, -1};
  }

  const PointCloud& cloud_;
  const GridPatches& grid_;
  const std::vector<PatchNormal>& normals_;
  const std::vector<Eigen::Vector3d>& directions_;
  float least_, most_;  ///< squared range [m²]
  const PointNoise& noise_;
  int cell_rows_, cell_cols_;
  std::vector<int> surface_of_patch_;  ///< index into patch_surfaces_; −1: not yet there
  std::vector<SurfaceAround> patch_surfaces_;
  std::vector<SurfaceAround> surfaces_;  ///< near the present block
  OpenCells result_;
};

}  // namespace

OpenCells openCells(const PointCloud& cloud, const GridPatches& grid,
                    const std::vector<PatchNormal>& normals,
                    const std::vector<Eigen::Vector3d>& directions, const SensorModel& sensor,
                    const PointNoise& noise) {
  return OpenCellGatherer(cloud, grid, normals, directions, sensor, noise).gather();
}

}  // namespace opp
