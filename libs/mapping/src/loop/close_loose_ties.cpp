// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/close_loose_ties.h"

#include "opp/mapping/loop/close_loops.h"
#include "opp/mapping/loop/map_conflict.h"
#include "opp/mapping/loop/tied_sets.h"

#include "loop/choose_keyframes.h"
#include "loop/loop_claims.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace opp::mapping {
namespace {

using Index = std::size_t;

using Sets = std::vector<int>;  ///< number of each keyframe's set

int countOf(const Sets& sets) {
  return sets.empty() ? 0 : 1 + *std::max_element(sets.begin(), sets.end());
}

KeyframeViews membersOf(const MapState& map, const Sets& sets, int set) {
  KeyframeViews members;
  for (Index k = 0; k < sets.size(); ++k) {
    if (sets[k] == set) members.push_back(&map.keyframes[k]);
  }
  return members;
}

/// Claims of the keyframes of one set about another, by both sets' numbers.
std::map<std::pair<int, int>, ClaimPool> claimsBetween(const MapState& map, const Sets& sets,
                                                       const MapperParams& params) {
  std::map<std::pair<int, int>, ClaimPool> pools;
  std::vector<int> seen(Index(countOf(sets)), 0);
  for (Index k = 0; k < sets.size(); ++k) {
    const auto size = static_cast<int>(std::count(sets.begin(), sets.end(), sets[k]));
    if (seen[Index(sets[k])]++ % claimantStep(size) != 0) continue;
    // A place of one scan proves no more than that scan: it may fit at a wrong place, whoever
    // looks.
    const auto elsewhere = [&](int other) {
      const int set = sets[Index(other)];
      return set != sets[k] &&
             std::count(sets.begin(), sets.end(), set) >= params.loop.confirmations;
    };
    for (const PlaceClaim& claim : loopClaims(map, static_cast<int>(k), elsewhere, params)) {
      const std::pair<int, int> between(sets[Index(claim.keyframe_a)], sets[k]);
      pools.try_emplace(between, params.loop, params.loop.confirmations).first->second.add(claim);
    }
  }
  return pools;
}

bool closeOne(const Sets& sets, const MapperParams& params, MapState& map) {
  for (const auto& [between, pool] : claimsBetween(map, sets, params)) {
    const std::vector<PlaceClaim> agreed = pool.agreed();
    if (agreed.empty()) continue;
    const double conflict =
        conflictOf(membersOf(map, sets, between.first), membersOf(map, sets, between.second),
                   agreed.front().map_a_from_map_b, params)
            .value_or(1.0);
    if (conflict > params.global_alignment.max_conflict) continue;
    if (acceptClaims(agreed, params, map) > 0) return true;
  }
  return false;
}

}  // namespace

int closeLooseTies(double max_variance, const MapperParams& params, MapState& map) {
  int closed = 0;
  Sets sets = tiedSets(map, max_variance);
  while (countOf(sets) > 1 && closeOne(sets, params, map)) {
    ++closed;
    Sets tied = tiedSets(map, max_variance);
    // A loop that fixes too little would be found again and again.
    if (countOf(tied) >= countOf(sets)) break;
    sets = std::move(tied);
  }
  return closed;
}

}  // namespace opp::mapping
