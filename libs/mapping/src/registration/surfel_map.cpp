// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/registration/surfel_map.h"

#include <cmath>
#include <limits>

namespace opp::mapping {

std::size_t SurfelMap::KeyHash::operator()(const Key& key) const {
  // Three large odd multipliers spread neighbouring voxels; the final shift mixes high bits into
  // the low ones, which the power-of-two table uses.
  std::uint64_t h = static_cast<std::uint32_t>(key.x) * 0x9E3779B97F4A7C15ULL;
  h ^= static_cast<std::uint32_t>(key.y) * 0xC2B2AE3D27D4EB4FULL;
  h ^= static_cast<std::uint32_t>(key.z) * 0x165667B19E3779F9ULL;
  return static_cast<std::size_t>(h ^ (h >> 29U));
}

SurfelMap::SurfelMap(double voxel_size, double normal_gate)
    : voxel_size_(voxel_size),
      inverse_size_(static_cast<float>(1.0 / voxel_size)),
      min_cosine_(static_cast<float>(std::cos(normal_gate))) {}

void SurfelMap::insert(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, float variance,
                       int landmark) {
  const Eigen::Vector3f cell = (point * inverse_size_).array().floor();
  const Key key{static_cast<std::int32_t>(cell.x()), static_cast<std::int32_t>(cell.y()),
                static_cast<std::int32_t>(cell.z())};
  const auto [voxel, is_new] = first_of_voxel_.try_emplace(key, -1);
  const float weight = 1.0F / variance;
  for (std::int32_t i = voxel->second; i >= 0; i = surfels_[static_cast<std::size_t>(i)].next) {
    Surfel& surfel = surfels_[static_cast<std::size_t>(i)].surfel;
    if (surfel.landmark != landmark || surfel.normal.dot(normal) < min_cosine_) continue;
    surfel.weight += weight;
    const float share = weight / surfel.weight;
    surfel.mean += share * (point - surfel.mean);
    surfel.normal = (surfel.normal + share * (normal - surfel.normal)).normalized();
    return;
  }
  surfels_.push_back({{point, normal, weight, landmark}, voxel->second});
  voxel.value() = static_cast<std::int32_t>(surfels_.size()) - 1;
}

const Surfel* SurfelMap::closest(const Eigen::Vector3f& point,
                                 const Eigen::Vector3f& normal) const {
  // The eight voxels around the nearest voxel corner contain every surfel within half a voxel.
  const Eigen::Vector3f cell = (point * inverse_size_).array() - 0.5F;
  const Key base{static_cast<std::int32_t>(std::floor(cell.x())),
                 static_cast<std::int32_t>(std::floor(cell.y())),
                 static_cast<std::int32_t>(std::floor(cell.z()))};
  const Surfel* best = nullptr;
  float best_distance = std::numeric_limits<float>::max();
  for (int corner = 0; corner < 8; ++corner) {
    const Key key{base.x + (corner & 1), base.y + ((corner >> 1) & 1), base.z + (corner >> 2)};
    const auto voxel = first_of_voxel_.find(key);
    if (voxel == first_of_voxel_.end()) continue;
    for (std::int32_t i = voxel->second; i >= 0; i = surfels_[static_cast<std::size_t>(i)].next) {
      const Surfel& surfel = surfels_[static_cast<std::size_t>(i)].surfel;
      if (surfel.normal.dot(normal) < min_cosine_) continue;
      const float distance = (surfel.mean - point).squaredNorm();
      if (distance < best_distance) {
        best_distance = distance;
        best = &surfel;
      }
    }
  }
  return best;
}

}  // namespace opp::mapping
