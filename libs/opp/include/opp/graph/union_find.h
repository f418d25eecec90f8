// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace opp {

/// Disjoint sets over 0 … count − 1. Almost constant time per operation.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  /// The representative of i's set.
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }

  /// Joins both sets; the representative of `into`'s set stands for the union.
  void join(std::size_t into, std::size_t other) { parent_[root(other)] = root(into); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace opp
