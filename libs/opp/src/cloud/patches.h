// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace opp {

/// Count, first and second moments of some points relative to an origin that all of them share, so
/// that sets are joined by adding ten numbers: n, Σx, Σy, Σz, Σxx, Σxy, Σxz, Σyy, Σyz, Σzz.
using MomentSums = Eigen::Array<double, 10, 1>;

/// Moments about another origin: `sums` are relative to a point that lies at `offset` from it.
inline MomentSums shifted(const MomentSums& sums, const Eigen::Vector3d& offset) {
  const double n = sums[0];
  const double x = offset.x(), y = offset.y(), z = offset.z();
  MomentSums out = sums;
  out.segment<3>(1) += n * offset.array();
  out[4] += 2.0 * x * sums[1] + n * x * x;
  out[5] += x * sums[2] + y * sums[1] + n * x * y;
  out[6] += x * sums[3] + z * sums[1] + n * x * z;
  out[7] += 2.0 * y * sums[2] + n * y * y;
  out[8] += y * sums[3] + z * sums[2] + n * y * z;
  out[9] += 2.0 * z * sums[3] + n * z * z;
  return out;
}

/// Area of the surface that so many pixels of a solid angle show: r² dω / cos [m²].
inline double patchArea(double pixels, double solid_angle, double height, double range) {
  constexpr double kLeastCosine = 0.1;
  const double cosine_range = std::max(std::abs(height), kLeastCosine * range);
  return pixels * solid_angle * range * range * range / cosine_range;
}

/// Neighbouring raw points taken together: the unit in which normals are estimated.
struct Patches {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of all moments, in the cloud's frame [m]
  std::vector<MomentSums> sums;                      ///< none is empty
  std::vector<Eigen::Vector3d> means;                ///< relative to the origin
  double pixel_angle = 0.0;  ///< between the rays of grid neighbours, the closer ones; 0: no grid
  double solid_angle = 0.0;  ///< of a pixel of the grid [sr]; 0: no grid
  double edge = 0.0;         ///< of the cells that are the patches where there is no grid [m]

  std::size_t size() const { return sums.size(); }
  void reserve(std::size_t count) {
    sums.reserve(count);
    means.reserve(count);
  }
  /// Edge of the square of surface that a patch of so many points stands for [m].
  double extentOf(double points, const Eigen::Vector3d& normal,
                  const Eigen::Vector3d& to_viewpoint) const {
    if (solid_angle == 0.0) return edge;
    const double height = normal.dot(to_viewpoint);
    return std::sqrt(patchArea(points, solid_angle, height, to_viewpoint.norm()));
  }
  void add(const MomentSums& patch_sums) {
    sums.push_back(patch_sums);
    means.emplace_back(patch_sums.segment<3>(1) / patch_sums[0]);
  }
};

/// What a window of patches adds up to: points, and for n points in each patch the second moments
/// of the patches' means, Σ n m mᵀ (xx, xy, xz, yy, yz, zz).
struct WindowSums {
  Eigen::Array<double, 16, 1> values = Eigen::Array<double, 16, 1>::Zero();
  int patches = 0;
  /// The patches fill a square of a grid, so that their rays spread in two directions.
  bool complete = false;

  void add(const MomentSums& patch, const Eigen::Vector3d& mean) {
    values.head<10>() += patch;
    const Eigen::Vector3d first = patch.segment<3>(1);  // n m
    values.segment<3>(10) += first.x() * mean.array();
    values.segment<2>(13) += first.y() * mean.tail<2>().array();
    values[15] += first.z() * mean.z();
    ++patches;
  }
};

/// Windows around patches, of a radius in patches. One thread at a time: implementations may keep
/// scratch.
class PatchWindows {
 public:
  virtual ~PatchWindows() = default;
  virtual WindowSums sums(int patch, int radius) = 0;
  /// Patches of the window, itself included: replaces the vector's content.
  virtual void members(int patch, int radius, std::vector<int>& members) = 0;
  /// Patches whose windows hold this patch and differ most: replaces the vector's content.
  virtual void shifted(int patch, int radius, std::vector<int>& centers) = 0;
};

}  // namespace opp
