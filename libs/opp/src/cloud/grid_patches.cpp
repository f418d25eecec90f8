// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/grid_patches.h"

#include "cloud/depth_image.h"
#include "cloud/range_gate.h"

#include <algorithm>
#include <cmath>

namespace opp {
namespace {

/// Amid the points, where sums of coordinates lose the fewest digits.
Eigen::Vector3d roughCenter(const PointCloud& cloud, const RangeGate& gate) {
  constexpr std::size_t kSamples = 500;
  const std::size_t stride = std::max<std::size_t>(1, cloud.size() / kSamples);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    if (!gate.contains(cloud.points[i] - cloud.viewpoint)) continue;
    sum += cloud.points[i].cast<double>();
    count += 1.0;
  }
  return count > 0.0 ? Eigen::Vector3d(sum / count) : cloud.viewpoint.cast<double>();
}

struct BlockShape {
  int rows = 1;
  int cols = 1;
};

BlockShape blockShape(const PointCloud& cloud, const GridAngles& angles, std::size_t target) {
  const double pixels =
      std::max(1.0, static_cast<double>(cloud.size()) / static_cast<double>(target));
  const double ratio = angles.row > 0.0 && angles.col > 0.0 ? angles.row / angles.col : 1.0;
  const double rows =
      std::clamp(std::round(std::sqrt(pixels / ratio)), 1.0, static_cast<double>(cloud.rows));
  const double cols = std::clamp(std::round(pixels / rows), 1.0, static_cast<double>(cloud.cols));
  return {static_cast<int>(rows), static_cast<int>(cols)};
}

/// Moments of one block about `origin`. Summed in single precision about the block's first point:
/// neighbours differ from it by little, and exactly.
MomentSums blockSums(const PointCloud& cloud, const RangeGate& gate, const Eigen::Vector3d& origin,
                     int row_begin, int row_end, int col_begin, int col_end) {
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  float n = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (int row = row_begin; row < row_end; ++row) {
    const Eigen::Vector3f* line =
        cloud.points.data() + static_cast<std::ptrdiff_t>(row) * cloud.cols;
    for (int col = col_begin; col < col_end; ++col) {
      const Eigen::Vector3f& point = line[col];
      if (!gate.contains(point - cloud.viewpoint)) continue;
      if (n == 0.0F) first = point;
      const Eigen::Vector3f d = point - first;
      n += 1.0F, x += d.x(), y += d.y(), z += d.z();
      xx += d.x() * d.x(), xy += d.x() * d.y(), xz += d.x() * d.z();
      yy += d.y() * d.y(), yz += d.y() * d.z(), zz += d.z() * d.z();
    }
  }
  const Eigen::Array<float, 10, 1> local =
      (Eigen::Array<float, 10, 1>() << n, x, y, z, xx, xy, xz, yy, yz, zz).finished();
  return shifted(local.cast<double>(), first.cast<double>() - origin);
}

}  // namespace

GridPatches makeGridPatches(const PointCloud& cloud, const SensorModel& sensor,
                            std::size_t target) {
  const RangeGate gate(sensor.min_range, sensor.max_range);
  const GridAngles angles = gridAngles(cloud, sensor);
  const BlockShape shape = blockShape(cloud, angles, target);
  GridPatches grid;
  grid.rows = (cloud.rows + shape.rows - 1) / shape.rows;
  grid.cols = (cloud.cols + shape.cols - 1) / shape.cols;
  grid.block_rows = shape.rows;
  grid.block_cols = shape.cols;
  grid.columns_wrap = cloud.columns_wrap;
  grid.patches.origin = roughCenter(cloud, gate);
  const double farthest = sensor.farthestSurface();
  const Eigen::Vector3d viewpoint = cloud.viewpoint.cast<double>() - grid.patches.origin;
  const auto rangeOf = [&](const MomentSums& sums) {
    return (sums.segment<3>(1).matrix() / sums[0] - viewpoint).norm();
  };
  grid.patches.pixel_angle = std::min(angles.row, angles.col);
  grid.patches.solid_angle = angles.row * angles.col;
  grid.patches.reserve(static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.cols));
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const MomentSums sums = blockSums(cloud, gate, grid.patches.origin, r * shape.rows,
                                        std::min(cloud.rows, (r + 1) * shape.rows), c * shape.cols,
                                        std::min(cloud.cols, (c + 1) * shape.cols));
      const bool left_out = sums[0] == 0.0 || rangeOf(sums) > farthest;
      grid.patch_of_block.push_back(left_out ? -1 : static_cast<int>(grid.patches.size()));
      if (left_out) continue;
      grid.block_of_patch.push_back(r * grid.cols + c);
      grid.patches.add(sums);
    }
  }
  return grid;
}

GridWindows::GridWindows(const GridPatches& grid, int max_radius)
    : grid_(grid),
      margin_(grid.columns_wrap ? std::min(max_radius, grid.cols) : 0),
      stride_(grid.cols + 2 * margin_ + 1),
      areas_(static_cast<std::size_t>(grid.rows + 1) * static_cast<std::size_t>(stride_)) {
  for (int row = 0; row < grid.rows; ++row) {
    WindowSums line;
    for (int col = 0; col + 1 < stride_; ++col) {
      const int patch = patchAt(row, col - margin_);
      if (patch >= 0) {
        const auto k = static_cast<std::size_t>(patch);
        line.add(grid.patches.sums[k], grid.patches.means[k]);
      }
      const WindowSums& above = area(row, col + 1);
      WindowSums& here = area(row + 1, col + 1);
      here.values = above.values + line.values;
      here.patches = above.patches + line.patches;
    }
  }
}

int GridWindows::reach(int radius) const {
  return grid_.columns_wrap ? std::min(radius, (grid_.cols - 1) / 2) : radius;
}

int GridWindows::patchAt(int row, int col) const {
  if (row < 0 || row >= grid_.rows) return -1;
  if (!grid_.columns_wrap && (col < 0 || col >= grid_.cols)) return -1;
  const int inside = col < 0 ? col + grid_.cols : (col >= grid_.cols ? col - grid_.cols : col);
  return grid_.patch_of_block[static_cast<std::size_t>(row * grid_.cols + inside)];
}

WindowSums GridWindows::sums(int patch, int radius) {
  const int block = grid_.block_of_patch[static_cast<std::size_t>(patch)];
  const int row = block / grid_.cols, col = block % grid_.cols + margin_;
  const int top = std::max(0, row - radius), bottom = std::min(grid_.rows, row + radius + 1);
  const int left = std::max(0, col - reach(radius));
  const int right = std::min(stride_ - 1, col + reach(radius) + 1);
  const WindowSums &outer = area(bottom, right), &above = area(top, right);
  const WindowSums &beside = area(bottom, left), &corner = area(top, left);
  WindowSums window;
  window.values = (outer.values - above.values) - (beside.values - corner.values);
  window.patches = outer.patches - above.patches - beside.patches + corner.patches;
  window.complete = window.patches == (2 * radius + 1) * (2 * radius + 1);
  return window;
}

void GridWindows::members(int patch, int radius, std::vector<int>& members) {
  members.clear();
  const int block = grid_.block_of_patch[static_cast<std::size_t>(patch)];
  const int row = block / grid_.cols, col = block % grid_.cols;
  for (int r = row - radius; r <= row + radius; ++r) {
    for (int c = col - reach(radius); c <= col + reach(radius); ++c) {
      const int member = patchAt(r, c);
      if (member >= 0) members.push_back(member);
    }
  }
}

void GridWindows::shifted(int patch, int radius, std::vector<int>& centers) {
  centers.clear();
  const int block = grid_.block_of_patch[static_cast<std::size_t>(patch)];
  const int row = block / grid_.cols, col = block % grid_.cols;
  for (const int r : {row - radius, row, row + radius}) {
    for (const int c : {col - reach(radius), col, col + reach(radius)}) {
      const int center = patchAt(r, c);
      if (center >= 0) centers.push_back(center);
    }
  }
}

}  // namespace opp
