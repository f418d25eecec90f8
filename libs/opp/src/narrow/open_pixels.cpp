// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/open_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace opp {
namespace {

/// Edge of a block in pixels; most blocks lie on one surface as a whole.
constexpr int kBlock = 4;
constexpr std::size_t kPixels = kBlock * kBlock;
/// Edge of the cells whose means are tested, in pixels.
constexpr int kCell = 2;
/// Of 16 pixels on a surface, one in a hundred times one is farther from it than this many
/// standard deviations.
constexpr double kBlockSigmas = 3.5;
/// The surface of the block before serves if a pixel is this near to it; else all are tried.
constexpr double kSurelySigmas = 1.0;

class OpenPixelFinder {
 public:
  OpenPixelFinder(const DepthImage& image, const std::vector<KnownSurface>& surfaces,
                  const NarrowParams& params)
      : image_(image),
        surfaces_(surfaces),
        squared_gate_(params.gate * params.gate),
        rows_((image.rows() + kBlock - 1) / kBlock),
        cols_((image.cols() + kBlock - 1) / kBlock),
        surface_of_(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_), -1),
        open_(image.size(), 0) {}

  std::vector<std::uint8_t> find() {
    std::vector<int> mixed;
    for (int block = 0; block < rows_ * cols_; ++block) {
      if (!isOnOneSurface(block)) mixed.push_back(block);
    }
    for (const int block : mixed) markOpen(block);
    return std::move(open_);
  }

 private:
  /// What was measured in a block.
  struct Block {
    std::array<float, kPixels> x, y, z;
    std::array<int, kPixels> pixel, cell;
    std::size_t size = 0;

    Eigen::Vector3f point(std::size_t i) const { return {x[i], y[i], z[i]}; }
  };

  Block blockAt(int index) const {
    Block block;
    const int top = index / cols_ * kBlock, left = index % cols_ * kBlock;
    for (int row = top; row < std::min(image_.rows(), top + kBlock); ++row) {
      for (int col = left; col < std::min(image_.cols(), left + kBlock); ++col) {
        const int pixel = image_.indexOf(row, col);
        const Eigen::Vector3f point = image_.point(pixel);
        if (!image_.inRange(point)) continue;
        const std::size_t at = block.size++;
        block.x[at] = point.x(), block.y[at] = point.y(), block.z[at] = point.z();
        block.pixel[at] = pixel;
        block.cell[at] = (row - top) / kCell * (kBlock / kCell) + (col - left) / kCell;
      }
    }
    return block;
  }

  double varianceAt(const KnownSurface& surface, const Eigen::Vector3f& point) const {
    return surface.variance(image_.noise(), static_cast<double>(point.squaredNorm()));
  }

  /// Squared offset over its variance; infinite where the surface cannot be.
  double misfit(const KnownSurface& surface, const Eigen::Vector3f& point) const {
    if (!surface.reaches(point)) return std::numeric_limits<double>::infinity();
    const double offset = surface.offset(point);
    return offset * offset / varianceAt(surface, point);
  }

  const KnownSurface& surface(int index) const {
    return surfaces_[static_cast<std::size_t>(index)];
  }

  /// The nearest surface, by the noise; −1: none near.
  int surfaceAt(int block, const Eigen::Vector3f& point) const {
    for (const int before : {block % cols_ > 0 ? block - 1 : -1, block - cols_}) {
      const int known = before < 0 ? -1 : surface_of_[static_cast<std::size_t>(before)];
      if (known >= 0 && misfit(surface(known), point) < kSurelySigmas * kSurelySigmas) return known;
    }
    int nearest = -1;
    double least = kBlockSigmas * kBlockSigmas;
    for (int k = 0; k < static_cast<int>(surfaces_.size()); ++k) {
      const double here = misfit(surface(k), point);
      if (here < least) least = here, nearest = k;
    }
    return nearest;
  }

  /// A pixel that was measured, if possible amid the block; −1: none was.
  int pixelIn(int index) const {
    const int row = std::min(image_.rows() - 1, index / cols_ * kBlock + kBlock / 2);
    const int col = std::min(image_.cols() - 1, index % cols_ * kBlock + kBlock / 2);
    const int middle = image_.indexOf(row, col);
    if (image_.inRange(image_.point(middle))) return middle;
    const Block block = blockAt(index);
    return block.size == 0 ? -1 : block.pixel[block.size / 2];
  }

  /// True also where nothing was measured.
  bool isOnOneSurface(int index) {
    const int middle = pixelIn(index);
    if (middle < 0) return true;
    const Eigen::Vector3f inside = image_.point(middle);
    const int known = surfaceAt(index, inside);
    surface_of_[static_cast<std::size_t>(index)] = known;
    if (known < 0) return false;
    const Eigen::Vector3f normal = surface(known).normal;
    const float height = surface(known).height;
    const int top = index / cols_ * kBlock, left = index % cols_ * kBlock;
    // Without branches, which data would take at random.
    float sum = 0.0F, farthest = 0.0F, count = 0.0F;
    for (int row = top; row < std::min(image_.rows(), top + kBlock); ++row) {
      for (int col = left; col < std::min(image_.cols(), left + kBlock); ++col) {
        const Eigen::Vector3f point = image_.point(image_.indexOf(row, col));
        const bool measured = image_.inRange(point);
        const float offset = measured ? normal.dot(point) - height : 0.0F;
        sum += offset;
        farthest = std::max(farthest, std::abs(offset));
        count += measured ? 1.0F : 0.0F;
      }
    }
    const double variance = varianceAt(surface(known), inside);
    const double mean = static_cast<double>(sum / count), most = static_cast<double>(farthest);
    return most * most <= kBlockSigmas * kBlockSigmas * variance &&
           mean * mean <=
               squared_gate_ * variance * image_.sensor().meanVariance(static_cast<double>(count));
  }

  void findSurfacesAround(int block) {
    around_.clear();
    const int row = block / cols_, col = block % cols_;
    for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
      for (int c = std::max(0, col - 1); c <= std::min(cols_ - 1, col + 1); ++c) {
        const int known = surface_of_[static_cast<std::size_t>(r * cols_ + c)];
        if (known < 0) continue;
        if (std::find(around_.begin(), around_.end(), known) == around_.end()) {
          around_.push_back(known);
        }
      }
    }
  }

  void markOpen(int index) {
    findSurfacesAround(index);
    struct Cell {
      double ratios = 0.0;  ///< Σ offset / standard deviation
      double count = 0.0;
    };
    std::array<Cell, kPixels / (kCell * kCell)> cells;
    const Block block = blockAt(index);
    for (std::size_t i = 0; i < block.size; ++i) {
      double least = std::numeric_limits<double>::infinity(), offset = 0.0;
      for (const int k : around_) {
        const double here = misfit(surface(k), block.point(i));
        if (here < least) least = here, offset = surface(k).offset(block.point(i));
      }
      if (!(least <= squared_gate_)) {
        open_[static_cast<std::size_t>(block.pixel[i])] = 1;
        continue;
      }
      Cell& cell = cells[static_cast<std::size_t>(block.cell[i])];
      cell.ratios += std::copysign(std::sqrt(least), offset);
      cell.count += 1.0;
    }
    for (std::size_t i = 0; i < block.size; ++i) {
      const Cell& cell = cells[static_cast<std::size_t>(block.cell[i])];
      if (cell.count == 0.0) continue;
      const double mean = cell.ratios / cell.count;
      if (mean * mean > squared_gate_ * image_.sensor().meanVariance(cell.count)) {
        open_[static_cast<std::size_t>(block.pixel[i])] = 1;
      }
    }
  }

  const DepthImage& image_;
  const std::vector<KnownSurface>& surfaces_;
  double squared_gate_;
  int rows_, cols_;              ///< of blocks
  std::vector<int> surface_of_;  ///< per block: −1: none
  std::vector<int> around_;      ///< surfaces of a block and its neighbours
  std::vector<std::uint8_t> open_;
};

}  // namespace

std::vector<std::uint8_t> openPixels(const DepthImage& image,
                                     const std::vector<KnownSurface>& surfaces,
                                     const NarrowParams& params) {
  return OpenPixelFinder(image, surfaces, params).find();
}

}  // namespace opp
