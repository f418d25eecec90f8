// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace opp {

/// visit(i, k), i < k, once for each two cells of a grid that touch (8-neighbourhood).
/// \param cells with members row and col, integers; sorted by row, then column, each once. O(size).
template <typename Cell, typename Visit>
void visitNeighbours(const std::vector<Cell>& cells, const Visit& visit) {
  std::size_t above = 0;  // the first cell that is not before the neighbour above on the left
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i];
    if (i > 0 && cells[i - 1].row == cell.row && cells[i - 1].col + 1 == cell.col) visit(i - 1, i);
    const auto isBefore = [&](const Cell& other) {
      return other.row < cell.row - 1 || (other.row == cell.row - 1 && other.col < cell.col - 1);
    };
    while (isBefore(cells[above])) ++above;
    for (std::size_t k = above; cells[k].row < cell.row && cells[k].col <= cell.col + 1; ++k) {
      visit(k, i);
    }
  }
}

}  // namespace opp
