// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "narrow/pixel_blocks.h"

#include <algorithm>
#include <cstddef>

namespace opp {

std::vector<PixelBlock> pixelBlocks(const DepthImage& image, const std::vector<int>& pixels,
                                    int edge) {
  std::vector<PixelBlock> blocks;
  std::vector<PixelBlock> line(static_cast<std::size_t>(image.cols() / edge + 1));
  int row = 0, first = image.cols(), last = -1;  // blocks of the line that have pixels
  const auto finishLine = [&] {
    for (int col = first; col <= last; ++col) {
      PixelBlock& block = line[static_cast<std::size_t>(col)];
      if (block.count == 0.0) continue;
      blocks.push_back({row, col, block.point / block.count, block.count});
      block = {};
    }
    first = image.cols(), last = -1;
  };
  for (const int pixel : pixels) {
    if (pixel / image.cols() / edge != row) finishLine();
    row = pixel / image.cols() / edge;
    const int col = pixel % image.cols() / edge;
    first = std::min(first, col), last = std::max(last, col);
    PixelBlock& block = line[static_cast<std::size_t>(col)];
    block.point += image.point(pixel).cast<double>();
    block.count += 1.0;
  }
  finishLine();
  return blocks;
}

}  // namespace opp
