// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace opp::mapping {

/// A pair that may be assigned to each other, at a cost.
struct AssignmentCandidate {
  std::size_t left = 0;
  std::size_t right = 0;
  double cost = 0.0;  ///< finite
};

/// Of all ways to pair left and right elements one to one along candidates, the one with the most
/// pairs, and among these the one with the least sum of costs (successive shortest paths). A greedy
/// choice by cost would lose pairs where the cheapest one takes an element that another one needs.
/// The same candidates in the same order give the same result.
/// \return for each left element the index of its candidate, or −1. O(pairs · elements ·
/// candidates) at worst; near-linear for small groups of rivals. \throws std::invalid_argument if
/// an index is out of range or a cost not finite.
std::vector<int> assignOneToOne(std::size_t left_count, std::size_t right_count,
                                const std::vector<AssignmentCandidate>& candidates);

}  // namespace opp::mapping
