// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/open_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace opp {
namespace {

/// Edge of the cells whose means are tested, in pixels.
constexpr int kCell = 2;
/// The nearest surface is looked for among those within so many standard deviations.
constexpr double kNearSigmas = 3.5;
/// The surface of the block before serves if the middle is this near to it; else all are tried.
constexpr double kSurelySigmas = 1.0;
/// Of blocks on a surface, one in 150 scatters by more than as many standard deviations.
constexpr double kScatterSigmas = 2.5;

/// What the mean of `count` squares of standard normal numbers rarely exceeds (Wilson and Hilferty,
/// PNAS 1931).
double mostMeanSquare(double count) {
  const double variance = 2.0 / (9.0 * count);
  return std::pow(1.0 - variance + kScatterSigmas * std::sqrt(variance), 3);
}

/// Σ (n·x)² of the points that the sums are of.
double squaresAlong(const Eigen::Vector3d& n, const MomentSums& sums) {
  return n.x() * n.x() * sums[4] + n.y() * n.y() * sums[7] + n.z() * n.z() * sums[9] +
         2.0 * (n.x() * n.y() * sums[5] + n.x() * n.z() * sums[6] + n.y() * n.z() * sums[8]);
}

class OpenPixelFinder {
 public:
  OpenPixelFinder(const DepthImage& image, const GridPatches& grid,
                  const std::vector<KnownSurface>& surfaces, const NarrowParams& params)
      : image_(image),
        grid_(grid),
        surfaces_(surfaces),
        squared_gate_(params.gate * params.gate),
        most_mean_square_(mostMeanSquare(static_cast<double>(grid.block_rows * grid.block_cols))),
        surface_of_(grid.patch_of_block.size(), kNone),
        open_(image.size(), 0) {}

  std::vector<std::uint8_t> find() {
    std::vector<int> mixed;
    for (int block = 0; block < grid_.rows * grid_.cols; ++block) {
      if (!isOnOneSurface(block)) mixed.push_back(block);
    }
    for (const int block : mixed) markOpen(block);
    return std::move(open_);
  }

 private:
  static constexpr int kNone = -1;

  /// Squared offset over its variance; infinite where the surface cannot be.
  static double misfit(const KnownSurface& surface, const Eigen::Vector3f& point) {
    return surface.reaches(point) ? surface.misfit(point) : std::numeric_limits<double>::infinity();
  }

  const KnownSurface& surface(int index) const {
    return surfaces_[static_cast<std::size_t>(index)];
  }

  /// The nearest surface, by the noise of a pixel.
  int surfaceAt(int block, const Eigen::Vector3f& point) const {
    for (const int before : {block % grid_.cols > 0 ? block - 1 : kNone, block - grid_.cols}) {
      const int known = before < 0 ? kNone : surface_of_[static_cast<std::size_t>(before)];
      if (known >= 0 && misfit(surface(known), point) < kSurelySigmas * kSurelySigmas) return known;
    }
    int nearest = kNone;
    double least = kNearSigmas * kNearSigmas;
    for (int k = 0; k < static_cast<int>(surfaces_.size()); ++k) {
      const double here = misfit(surface(k), point);
      if (here < least) least = here, nearest = k;
    }
    return nearest;
  }

  /// True also where nothing was measured. The moments of the block's points tell.
  bool isOnOneSurface(int block) {
    const int patch = grid_.patch_of_block[static_cast<std::size_t>(block)];
    if (patch < 0) return true;
    const auto at = static_cast<std::size_t>(patch);
    const Eigen::Vector3d to_origin = grid_.patches.origin - image_.viewpoint();
    const Eigen::Vector3f middle = (grid_.patches.means[at] + to_origin).cast<float>();
    const int known = surfaceAt(block, middle);
    surface_of_[static_cast<std::size_t>(block)] = known;
    if (known < 0) return false;
    const MomentSums& sums = grid_.patches.sums[at];
    const Eigen::Vector3d normal = surface(known).normal().cast<double>();
    const double shift = surface(known).offset(to_origin.cast<float>());
    const double mean = normal.dot(grid_.patches.means[at]) + shift;
    const double square = squaresAlong(normal, sums) / sums[0] + shift * (2.0 * mean - shift);
    const double variance = surface(known).variance(static_cast<double>(middle.squaredNorm()));
    return square <= most_mean_square_ * variance &&
           mean * mean <= squared_gate_ * variance * image_.sensor().meanVariance(sums[0]);
  }

  void findSurfacesAround(int block) {
    around_.clear();
    const int row = block / grid_.cols, col = block % grid_.cols;
    for (int r = std::max(0, row - 1); r <= std::min(grid_.rows - 1, row + 1); ++r) {
      for (int c = std::max(0, col - 1); c <= std::min(grid_.cols - 1, col + 1); ++c) {
        const int known = surface_of_[static_cast<std::size_t>(r * grid_.cols + c)];
        if (known < 0) continue;
        if (std::find(around_.begin(), around_.end(), known) == around_.end()) {
          around_.push_back(known);
        }
      }
    }
  }

  struct Cell {
    double ratios = 0.0, count = 0.0;  ///< of its pixels near a surface
  };
  struct Pixel {
    int index, cell;
    double ratio;  ///< offset from the nearest surface, in standard deviations
  };
  /// What was measured in a block, and how far from the surfaces around.
  void findPixels(int block) {
    pixels_.clear();
    const int cells_per_row = (grid_.block_cols + kCell - 1) / kCell;
    const int top = block / grid_.cols * grid_.block_rows;
    const int left = block % grid_.cols * grid_.block_cols;
    const int bottom = std::min(image_.rows(), top + grid_.block_rows);
    const int right = std::min(image_.cols(), left + grid_.block_cols);
    for (int row = top; row < bottom; ++row) {
      for (int col = left; col < right; ++col) {
        const int index = image_.indexOf(row, col);
        const Eigen::Vector3f point = image_.point(index);
        if (!image_.inRange(point)) continue;
        const int cell = (row - top) / kCell * cells_per_row + (col - left) / kCell;
        pixels_.push_back({index, cell, ratioAt(point)});
      }
    }
  }

  double ratioAt(const Eigen::Vector3f& point) const {
    double least = std::numeric_limits<double>::infinity(), offset = 1.0;
    for (const int k : around_) {
      const double here = misfit(surface(k), point);
      if (here < least) least = here, offset = surface(k).offset(point);
    }
    return std::copysign(std::sqrt(least), offset);
  }

  void markOpen(int block) {
    findSurfacesAround(block);
    findPixels(block);
    cells_.assign(static_cast<std::size_t>(grid_.block_rows * grid_.block_cols), {});
    for (const Pixel& pixel : pixels_) {
      if (!(pixel.ratio * pixel.ratio <= squared_gate_)) continue;
      Cell& cell = cells_[static_cast<std::size_t>(pixel.cell)];
      cell.ratios += pixel.ratio;
      cell.count += 1.0;
    }
    for (const Pixel& pixel : pixels_) {
      const Cell& cell = cells_[static_cast<std::size_t>(pixel.cell)];
      const double mean = cell.ratios / cell.count;
      const bool is_near = pixel.ratio * pixel.ratio <= squared_gate_;
      if (is_near && mean * mean <= squared_gate_ * image_.sensor().meanVariance(cell.count))
        continue;
      open_[static_cast<std::size_t>(pixel.index)] = 1;
    }
  }

  const DepthImage& image_;
  const GridPatches& grid_;
  const std::vector<KnownSurface>& surfaces_;
  double squared_gate_, most_mean_square_;
  std::vector<int> surface_of_;  ///< per block
  std::vector<int> around_;      ///< surfaces of a block and its neighbours
  std::vector<Pixel> pixels_;    ///< of a block
  std::vector<Cell> cells_;      ///< of a block
  std::vector<std::uint8_t> open_;
};

}  // namespace

std::vector<std::uint8_t> openPixels(const DepthImage& image, const GridPatches& grid,
                                     const std::vector<KnownSurface>& surfaces,
                                     const NarrowParams& params) {
  return OpenPixelFinder(image, grid, surfaces, params).find();
}

}  // namespace opp
