// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/pixel_blocks.h"

#include <algorithm>
#include <tuple>

namespace opp {

std::vector<PixelBlock> pixelBlocks(const DepthImage& image, const std::vector<int>& pixels,
                                    int edge) {
  struct Entry {
    int row, col, pixel;
    bool operator<(const Entry& other) const {
      return std::tie(row, col, pixel) < std::tie(other.row, other.col, other.pixel);
    }
  };
  std::vector<Entry> entries;
  entries.reserve(pixels.size());
  for (const int pixel : pixels) {
    entries.push_back({pixel / image.cols() / edge, pixel % image.cols() / edge, pixel});
  }
  std::sort(entries.begin(), entries.end());
  std::vector<PixelBlock> blocks;
  for (const Entry& entry : entries) {
    if (blocks.empty() || blocks.back().row != entry.row || blocks.back().col != entry.col) {
      blocks.push_back({entry.row, entry.col});
    }
    blocks.back().point += image.point(entry.pixel).cast<double>();
    blocks.back().count += 1.0;
  }
  for (PixelBlock& block : blocks) block.point /= block.count;
  return blocks;
}

}  // namespace opp
