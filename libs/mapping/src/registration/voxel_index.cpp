// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration/voxel_index.h"

#include <Eigen/Geometry>

namespace opp::mapping {
namespace {

/// 32 MB of cells; more would cost more time to clear than it saves.
constexpr double kMaxCells = 4e6;
/// Samples whose normals differ by more than 60° are different surfaces.
constexpr float kSameSurface = 0.5F;

}  // namespace

VoxelIndex::VoxelIndex(const OrientedCloud& cloud, double cell, bool sided)
    : cloud_(cloud), sided_(sided) {
  if (cloud.size() == 0) return;
  chooseGrid(cell);
  for (std::size_t i = 0; i < cloud.size(); ++i) insert(static_cast<std::int32_t>(i));
}

void VoxelIndex::chooseGrid(double cell) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : cloud_.points) box.extend(p);
  const Eigen::Vector3d size = box.sizes().cast<double>();
  // One cell of margin on each side, so that the neighbours of every sample's cell exist.
  while ((size / cell + Eigen::Vector3d::Constant(4.0)).prod() > kMaxCells) cell *= 1.25;
  inverse_cell_ = static_cast<float>(1.0 / cell);
  low_ = box.min() - Eigen::Vector3f::Constant(static_cast<float>(1.5 * cell));
  counts_ = (size / cell).cast<int>() + Eigen::Vector3i::Constant(4);
  cells_.assign(static_cast<std::size_t>(counts_.x()) * static_cast<std::size_t>(counts_.y()) *
                    static_cast<std::size_t>(counts_.z()),
                Slots{-1, -1});
}

bool VoxelIndex::offer(std::int32_t sample, const Eigen::Vector3f& center,
                       std::int32_t& slot) const {
  if (slot < 0) {
    slot = sample;
    return true;
  }
  const auto holder = static_cast<std::size_t>(slot);
  const auto i = static_cast<std::size_t>(sample);
  if (cosine(cloud_.normals[holder], cloud_.normals[i]) < kSameSurface) return false;
  if ((cloud_.points[i] - center).squaredNorm() < (cloud_.points[holder] - center).squaredNorm()) {
    slot = sample;
  }
  return true;
}

void VoxelIndex::insert(std::int32_t sample) {
  // The eight cells whose centres are nearest.
  const Eigen::Vector3f in_cells =
      (cloud_.points[static_cast<std::size_t>(sample)] - low_) * inverse_cell_;
  const Eigen::Vector3i base =
      (in_cells.array() - 0.5F).floor().cast<int>().max(0).min(counts_.array() - 2);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3i c = base + Eigen::Vector3i(corner & 1, (corner >> 1) & 1, corner >> 2);
    const Eigen::Vector3f center =
        low_ + (c.cast<float>() + Eigen::Vector3f::Constant(0.5F)) / inverse_cell_;
    Slots& slots = cells_[indexOf(c)];
    if (!offer(sample, center, slots[0])) offer(sample, center, slots[1]);
  }
}

std::int32_t VoxelIndex::near(const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                              float min_cosine) const {
  const Eigen::Array3f c = (point - low_).array() * inverse_cell_;
  // Written so that NaN is outside, too.
  if (!(c.minCoeff() >= 0.0F && c.x() < static_cast<float>(counts_.x()) &&
        c.y() < static_cast<float>(counts_.y()) && c.z() < static_cast<float>(counts_.z()))) {
    return -1;
  }
  for (const std::int32_t i : cells_[indexOf(c.cast<int>())]) {
    if (i >= 0 && cosine(cloud_.normals[static_cast<std::size_t>(i)], normal) > min_cosine)
      return i;
  }
  return -1;
}

}  // namespace opp::mapping
