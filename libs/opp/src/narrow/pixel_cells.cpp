// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/pixel_cells.h"

#include <cstring>
#include <limits>

namespace opp {
namespace {

/// Of the open pixels in a cell; its count is 0 if there are too few, or a jump between them.
PixelCell cellAt(const DepthImage& image, const std::vector<std::uint8_t>& open, int row, int col) {
  constexpr int kEdge = PixelCell::kEdge;
  PixelCell cell;
  cell.row = row, cell.col = col;
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0F;
  for (int r = kEdge * row; r < std::min(image.rows(), kEdge * (row + 1)); ++r) {
    for (int c = kEdge * col; c < std::min(image.cols(), kEdge * (col + 1)); ++c) {
      const int pixel = image.indexOf(r, c);
      if (open[static_cast<std::size_t>(pixel)] == 0) continue;
      const Eigen::Vector3f point = image.point(pixel);
      const float range = point.norm();
      nearest = std::min(nearest, range), farthest = std::max(farthest, range);
      cell.point += point;
      ++cell.count;
    }
  }
  if (cell.count < 2 || image.jumps(nearest, farthest)) return {};
  cell.point /= static_cast<float>(cell.count);
  cell.range = cell.point.norm();
  return cell;
}

/// Most pixels are not: a search for a byte is faster than a look at each.
std::size_t nextOpen(const std::vector<std::uint8_t>& open, std::size_t from) {
  if (from >= open.size()) return open.size();
  const void* found = std::memchr(open.data() + from, 1, open.size() - from);
  if (found == nullptr) return open.size();
  return static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - open.data());
}

}  // namespace

PixelCells::PixelCells(const DepthImage& image, const std::vector<std::uint8_t>& open)
    : rows_((image.rows() + PixelCell::kEdge - 1) / PixelCell::kEdge),
      cols_((image.cols() + PixelCell::kEdge - 1) / PixelCell::kEdge),
      at_(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_), kUnseen) {
  for (std::size_t pixel = nextOpen(open, 0); pixel < open.size();
       pixel = nextOpen(open, pixel + 1)) {
    const int row = static_cast<int>(pixel) / image.cols() / PixelCell::kEdge;
    const int col = static_cast<int>(pixel) % image.cols() / PixelCell::kEdge;
    int& at = at_[static_cast<std::size_t>(row * cols_ + col)];
    if (at != kUnseen) continue;
    const PixelCell cell = cellAt(image, open, row, col);
    at = cell.count == 0 ? kNone : static_cast<int>(cells_.size());
    if (cell.count > 0) cells_.push_back(cell);
  }
}

}  // namespace opp
