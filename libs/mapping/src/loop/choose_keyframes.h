// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace opp::mapping {

/// Each so many of `keyframes` looks for its place, that about forty do: neighbours see the same.
inline int claimantStep(int keyframes) {
  constexpr int kClaimants = 40;
  return 1 + keyframes / kClaimants;
}

/// The first `count` of the candidates, each at a place of its own: apart(a, b) for all two of
/// them. O(candidates · count).
template <typename Candidate, typename Apart>
std::vector<Candidate> distinctPlaces(const std::vector<Candidate>& ranked, std::size_t count,
                                      const Apart& apart) {
  std::vector<Candidate> chosen;
  for (const Candidate& c : ranked) {
    if (chosen.size() == count) break;
    const bool new_place = std::all_of(chosen.begin(), chosen.end(),
                                       [&](const Candidate& other) { return apart(c, other); });
    if (new_place) chosen.push_back(c);
  }
  return chosen;
}

}  // namespace opp::mapping
