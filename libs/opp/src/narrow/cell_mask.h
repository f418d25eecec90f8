// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace opp {

/// One bit per cell of a grid, so that few reads tell which of many cells are marked.
class CellMask {
 public:
  CellMask(int rows, int cols)
      : rows_(rows),
        cols_(cols),
        words_(cols / kBits + 1),
        bits_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(words_), 0) {}

  void mark(int row, int col) { word(row, col / kBits) |= std::uint64_t{1} << (col % kBits); }
  void clear(int row, int col) { word(row, col / kBits) &= ~(std::uint64_t{1} << (col % kBits)); }

  /// Clears the marks in a square around a cell, itself included, and calls visit(row, col) for
  /// each, row by row.
  template <typename Visit>
  void takeAround(int row, int col, int radius, const Visit& visit) {
    const int left = std::max(0, col - radius), right = std::min(cols_ - 1, col + radius);
    for (int r = std::max(0, row - radius); r <= std::min(rows_ - 1, row + radius); ++r) {
      for (int w = left / kBits; w <= right / kBits; ++w) {
        const int first = std::max(left - w * kBits, 0),
                  last = std::min(right - w * kBits, kBits - 1);
        const std::uint64_t window =
            (~std::uint64_t{0} << first) & (~std::uint64_t{0} >> (kBits - 1 - last));
        std::uint64_t taken = word(r, w) & window;
        word(r, w) &= ~window;
        for (; taken != 0; taken &= taken - 1) visit(r, w * kBits + lowestBit(taken));
      }
    }
  }

 private:
  static constexpr int kBits = 64;
  static int lowestBit(std::uint64_t bits) { return __builtin_ctzll(bits); }
  std::uint64_t& word(int row, int index) {
    return bits_[static_cast<std::size_t>(row * words_ + index)];
  }

  int rows_, cols_;
  int words_;  ///< per row
  std::vector<std::uint64_t> bits_;
};

}  // namespace opp
