// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace opp::mapping {

/// Constant-time look-up of a sample near a point: a dense grid whose cells name the sample nearest
/// to their centre, and a second one that faces another way (thin walls, edges). Made for the many
/// thousand candidate poses of global alignment, where one memory access a point is what counts.
class VoxelIndex {
 public:
  /// \param cell edge of a cell [m] > 0; enlarged where the cloud would need too many cells
  /// \param sided false: normals of opposite sign count as the same
  VoxelIndex(const OrientedCloud& cloud, double cell, bool sided = true);

  /// A sample within about a cell of `point` whose normal has a cosine of more than `min_cosine`
  /// with `normal`; −1 if none. Each sample is found from all points within half a cell, unless
  /// another one is closer to the middle of the cell.
  std::int32_t near(const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                    float min_cosine) const;

  double cell() const { return 1.0 / static_cast<double>(inverse_cell_); }

 private:
  using Slots = std::array<std::int32_t, 2>;

  void chooseGrid(double cell);
  float cosine(const Eigen::Vector3f& a, const Eigen::Vector3f& b) const {
    return sided_ ? a.dot(b) : std::abs(a.dot(b));
  }
  void insert(std::int32_t sample);
  bool offer(std::int32_t sample, const Eigen::Vector3f& center, std::int32_t& slot) const;
  std::size_t indexOf(const Eigen::Vector3i& c) const {
    return (static_cast<std::size_t>(c.z()) * static_cast<std::size_t>(counts_.y()) +
            static_cast<std::size_t>(c.y())) *
               static_cast<std::size_t>(counts_.x()) +
           static_cast<std::size_t>(c.x());
  }

  const OrientedCloud& cloud_;
  bool sided_;
  float inverse_cell_ = 1.0F;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  Eigen::Vector3i counts_ = Eigen::Vector3i::Zero();
  std::vector<Slots> cells_;
};

}  // namespace opp::mapping
