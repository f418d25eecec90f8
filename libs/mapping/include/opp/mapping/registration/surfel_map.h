// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <tsl/robin_map.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp::mapping {

/// A patch of surface: the average of the samples of one voxel that face the same way.
struct Surfel {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();    ///< [m]
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit length
  float weight = 0.0F;                               ///< Σ 1/variance of its samples [1/m²]
  int landmark = -1;  ///< plane landmark its samples belong to; −1: none
};

/// Surfels in a voxel grid. A voxel holds one surfel per direction that its samples face, and one
/// per landmark, so the two sides of a thin wall stay apart. Copyable; queries are thread safe.
class SurfelMap {
 public:
  /// \param voxel_size edge of a voxel [m] > 0
  /// \param normal_gate samples and queries match a surfel whose normal differs by less [rad]
  SurfelMap(double voxel_size, double normal_gate);

  /// Adds a sample with offset variance [m²] > 0 along its unit normal. Amortized constant time.
  void insert(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, float variance,
              int landmark);

  /// The nearest surfel that faces the same way, in the eight voxels nearest to the point; null if
  /// none. Constant time.
  const Surfel* closest(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) const;

  /// Calls f(surfel) for each, in the order of their first samples.
  template <typename F>
  void forEach(F&& f) const {
    for (const Entry& entry : surfels_) f(entry.surfel);
  }

  double voxelSize() const { return voxel_size_; }
  std::size_t size() const { return surfels_.size(); }

 private:
  struct Key {
    std::int32_t x, y, z;
    bool operator==(const Key& other) const { return x == other.x && y == other.y && z == other.z; }
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };
  struct Entry {
    Surfel surfel;
    std::int32_t next = -1;  ///< next surfel of the same voxel
  };
  double voxel_size_;
  float inverse_size_;
  float min_cosine_;
  tsl::robin_map<Key, std::int32_t, KeyHash> first_of_voxel_;
  std::vector<Entry> surfels_;
};

}  // namespace opp::mapping
