// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud/strip_patches.h"

#include "opp/geometry/constants.h"
#include "opp/geometry/plane.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace opp {
namespace {

/// Raw points of the least strip: half of what makes a plane count as seen; beside edges a strip is
/// not clear of what it borders on.
constexpr double kLeastPoints = 150.0;
/// Cells farther from the height of their region, in standard deviations, are not on it: 1.2 % of
/// those that are.
constexpr double kRegionSigmas = 2.5;
/// Cells at one height scatter by their noise, variance 1, and cut off as above by 0.9; a slice of
/// a slanted surface fills the gate evenly, variance 2.1.
constexpr double kMostScatter = 1.3;
/// Least width in pixels: two leave no degree of freedom to lateral noise.
constexpr double kLeastWidth = 2.5;
/// Cells in a line have two neighbours each, in two lines five: seams between surfaces are lines.
constexpr double kLeastNeighbours = 3.5;
/// A fit whose normal is known worse cannot be told from that of a surface at 45° to it [rad].
constexpr double kMostAngleSigma = 0.2;
/// Error of the directions themselves, which are means of patches' normals [rad].
constexpr double kDirectionError = degToRad(1.0);
/// A part with fewer points is at the rim of the strip's blocks.
constexpr double kLeastPatchPoints = 4.0;

/// Adjoining cells at one height.
struct Region {
  std::vector<int> cells;
  double count = 0.0;    ///< of raw points
  double heights = 0.0;  ///< Σ height × points

  void clear() {
    cells.clear();
    count = heights = 0.0;
  }
  double height() const { return heights / count; }
  void add(int index, double points, double at) {
    cells.push_back(index);
    count += points;
    heights += at * points;
  }
};

/// Of a cell along a direction.
struct Height {
  double value = 0.0;  ///< [m]
  double gate = 0.0;   ///< squared distance that noise explains [m²]
};

/// Mean, scatter and noise of a region's cells, weighted by their points.
struct RegionMoments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double range = 0.0;
  double variance = 0.0;  ///< of one raw point along the direction [m²]
  double scatter = 0.0;   ///< mean (height / standard deviation)² of the cells
};

class StripFinder {
 public:
  StripFinder(const OpenCells& cells, const std::vector<Eigen::Vector3d>& directions,
              const SamplingParams& params, const PointNoise& noise, double pixel_angle)
      : cells_(cells),
        directions_(directions),
        params_(params),
        noise_(noise),
        pixel_angle_(pixel_angle),
        claimed_(cells.cells.size(), 0),
        searched_(directions.size(), claimed_),
        reached_(cells.cells.size(), 0) {
    for (const Eigen::Vector3d& direction : directions) {
      heights_.emplace_back();
      heights_.back().reserve(cells.cells.size());
      for (const OpenCell& cell : cells.cells) {
        const double gate = kRegionSigmas * kRegionSigmas * varianceOf(cell, direction, noise);
        heights_.back().push_back({direction.dot(cell.point), gate});
      }
    }
  }

  std::vector<StripPatch> find() {
    ignoreScattered();
    for (int seed = 0; seed < static_cast<int>(cells_.cells.size()); ++seed) {
      Region best;
      std::size_t direction = 0;
      for (std::size_t k = 0; k < directions_.size(); ++k) {
        Region region = searchAt(seed, k);
        if (region.count <= best.count) continue;
        best = std::move(region);
        direction = k;
      }
      if (best.cells.empty()) continue;
      for (const int index : best.cells) claimed_[static_cast<std::size_t>(index)] = 1;
      cutIntoPatches(best, directions_[direction]);
    }
    return std::move(patches_);
  }

 private:
  using Flags = std::vector<std::uint8_t>;

  /// Marks cells as claimed that adjoin too few others to be part of a strip.
  void ignoreScattered() {
    for (int seed = 0; seed < static_cast<int>(cells_.cells.size()); ++seed) {
      if (reached_[static_cast<std::size_t>(seed)] != 0) continue;
      Region region;
      const auto add = [&](int index) {
        int& reached = reached_[static_cast<std::size_t>(index)];
        if (reached == 0) region.add(index, cells_[index].count, 0.0);
        reached = 1;
      };
      add(seed);
      for (std::size_t next = 0; next < region.cells.size(); ++next) {
        cells_.visitAround(cells_[region.cells[next]], add);
      }
      if (region.count >= kLeastPoints) continue;
      for (const int index : region.cells) claimed_[static_cast<std::size_t>(index)] = 1;
    }
    search_ = 1;
  }

  /// The strip around a cell; empty if there is none, and its cells then are not searched again.
  Region searchAt(int seed, std::size_t k) {
    const auto at = static_cast<std::size_t>(seed);
    if (claimed_[at] != 0 || searched_[k][at] != 0) return {};
    const Region& region = grow(seed, heights_[k]);
    if (region.count >= kLeastPoints && isStrip(region, directions_[k])) return region;
    for (const int index : region.cells) searched_[k][static_cast<std::size_t>(index)] = 1;
    return {};
  }

  const Region& grow(int seed, const std::vector<Height>& heights) {
    Region& region = region_;
    region.clear();
    const auto add = [&](int index, const Height& height) {
      reached_[static_cast<std::size_t>(index)] = search_;
      region.add(index, cells_[index].count, height.value);
    };
    ++search_;
    add(seed, heights[static_cast<std::size_t>(seed)]);
    for (std::size_t next = 0; next < region.cells.size(); ++next) {
      cells_.visitAround(cells_[region.cells[next]], [&](int index) {
        const auto at = static_cast<std::size_t>(index);
        if (reached_[at] == search_ || claimed_[at] != 0) return;
        const double offset = heights[at].value * region.count - region.heights;
        const double square = offset * offset;
        // The squared gate times the squared points of the region.
        const double gate = heights[at].gate * region.count * (region.count + cells_[index].count);
        if (square <= gate) add(index, heights[at]);
      });
    }
    return region;
  }

  RegionMoments momentsOf(const Region& region, const Eigen::Vector3d& direction) const {
    RegionMoments moments;
    const Eigen::Vector3d origin = cells_[region.cells.front()].point;
    const auto size = static_cast<double>(region.cells.size());
    for (const int index : region.cells) {
      const OpenCell& cell = cells_[index];
      const Eigen::Vector3d step = cell.point - origin;
      const double share = cell.count / region.count;
      const double variance = varianceOf(cell, direction, noise_);
      const double offset = direction.dot(cell.point) - region.height();
      moments.mean += share * step;
      moments.covariance += share * step * step.transpose();
      moments.range += share * std::sqrt(cell.squared_range);
      moments.variance += share * cell.count * variance;
      moments.scatter += offset * offset / (variance * size);
    }
    moments.covariance -= moments.mean * moments.mean.transpose();
    moments.mean += origin;
    return moments;
  }

  /// Neighbours of a cell in the region of the present search.
  double meanNeighbours(const Region& region) const {
    double pairs = 0.0;
    for (const int cell : region.cells) {
      cells_.visitAround(cells_[cell], [&](int index) {
        pairs += index != cell && reached_[static_cast<std::size_t>(index)] == search_ ? 1.0 : 0.0;
      });
    }
    return pairs / static_cast<double>(region.cells.size());
  }

  bool isStrip(const Region& region, const Eigen::Vector3d& direction) const {
    const RegionMoments moments = momentsOf(region, direction);
    if (moments.scatter > kMostScatter || meanNeighbours(region) < kLeastNeighbours) return false;
    const Eigen::Vector3d ray = moments.mean.normalized();
    if (std::abs(ray.dot(direction)) < std::cos(params_.max_incidence)) return false;
    // Noise along the rays spreads the cells in the plane as well.
    const double cells_per_point = static_cast<double>(region.cells.size()) / region.count;
    const double ray_variance =
        noise_.expected(moments.range * moments.range, moments.range) * cells_per_point;
    const Eigen::Matrix3d surface = moments.covariance - ray_variance * ray * ray.transpose();
    const Eigen::Matrix<double, 3, 2> tangents = tangentBasis(direction);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(tangents.transpose() * surface *
                                                              tangents);
    // A rectangle of width w has variance w²/12.
    const double least_width = kLeastWidth * pixel_angle_ * moments.range;
    if (!(12.0 * axes.eigenvalues()[0] >= least_width * least_width)) return false;
    for (int k = 0; k < 2; ++k) {
      const double spread = axes.eigenvalues()[k];
      const double sigma = std::sqrt(moments.variance / (region.count * spread));
      const Eigen::Vector3d axis = tangents * axes.eigenvectors().col(k);
      const double turn = std::abs(axis.dot(surface * direction)) / spread;
      if (sigma > kMostAngleSigma || turn > params_.gate * sigma + kDirectionError) return false;
    }
    return true;
  }

  /// Appends the region block by block.
  void cutIntoPatches(const Region& region, const Eigen::Vector3d& direction) {
    std::vector<int> order = region.cells;
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return std::make_pair(cells_[a].block, a) < std::make_pair(cells_[b].block, b);
    });
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double count = 0.0, variances = 0.0;
      const int block = cells_[order[begin]].block;
      for (end = begin; end < order.size() && cells_[order[end]].block == block; ++end) {
        const OpenCell& cell = cells_[order[end]];
        sum += cell.count * cell.point;
        count += cell.count;
        variances += cell.count * cell.count * varianceOf(cell, direction, noise_);
      }
      if (count < kLeastPatchPoints) continue;
      const bool away = direction.dot(sum) > 0.0;
      patches_.push_back({sum / count, away ? Eigen::Vector3d(-direction) : direction,
                          std::sqrt(variances / count), count});
    }
  }

  const OpenCells& cells_;
  const std::vector<Eigen::Vector3d>& directions_;
  const SamplingParams& params_;
  const PointNoise& noise_;
  double pixel_angle_;
  Flags claimed_;                ///< per cell: part of a strip
  std::vector<Flags> searched_;  ///< per direction and cell: in a region that is no strip
  std::vector<std::vector<Height>> heights_;  ///< per direction and cell
  std::vector<int> reached_;                  ///< per cell: the last search that added it
  Region region_;                             ///< of the present search
  int search_ = 0;
  std::vector<StripPatch> patches_;
};

}  // namespace

std::vector<StripPatch> findStrips(const OpenCells& cells,
                                   const std::vector<Eigen::Vector3d>& directions,
                                   const SamplingParams& params, const PointNoise& noise,
                                   double pixel_angle) {
  return StripFinder(cells, directions, params, noise, pixel_angle).find();
}

}  // namespace opp
