// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/map_joiner.h"

#include "opp/mapping/backend/settle_map.h"
#include "opp/mapping/loop/close_loops.h"
#include "opp/mapping/loop/join_maps.h"
#include "opp/mapping/loop/map_conflict.h"
#include "opp/mapping/loop/match_place.h"
#include "opp/mapping/loop/place.h"

#include <algorithm>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Keyframes of a part that look for their places in the end, about.
constexpr int kClaimants = 40;

bool haveCommon(const std::set<int>& a, const std::set<int>& b) {
  return std::any_of(a.begin(), a.end(), [&](int id) { return b.count(id) > 0; });
}

/// The place was recognized where it cannot be.
void refute(const PlaceClaim& claim, MapPart& a, MapPart& b) {
  a.markRepeated(claim.keyframe_a);
  b.markRepeated(claim.keyframe_b);
}

}  // namespace

ClaimPool& MapJoiner::pool(int part_a, int part_b) {
  return pools_.try_emplace({part_a, part_b}, params_.loop).first->second;
}

std::vector<MapJoiner::Candidate> MapJoiner::candidates(const std::vector<MapPart>& parts,
                                                        Index claimant,
                                                        const Primitives& primitives) const {
  std::vector<Candidate> ranked;
  for (Index p = 0; p < parts.size(); ++p) {
    if (parts[p].id >= parts[claimant].id ||
        haveCommon(parts[p].history.origins, parts[claimant].history.origins))
      continue;
    const std::vector<double> likeness = parts[p].index.likeness(primitives);
    for (Index k = 0; k < likeness.size(); ++k) {
      if (likeness[k] > 0.0) ranked.push_back({likeness[k], p, static_cast<int>(k)});
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Candidate& x, const Candidate& y) { return x.likeness > y.likeness; });
  std::vector<Candidate> chosen;
  for (const Candidate& c : ranked) {
    if (chosen.size() == Index(params_.loop.max_candidates)) break;
    const Eigen::Vector3d view = parts[c.part].map.keyframes[Index(c.keyframe)].viewCentre();
    const bool new_place = std::all_of(chosen.begin(), chosen.end(), [&](const Candidate& other) {
      const Keyframe& k = parts[other.part].map.keyframes[Index(other.keyframe)];
      return other.part != c.part ||
             (k.viewCentre() - view).norm() > 0.5 * params_.loop.search_distance;
    });
    if (new_place) chosen.push_back(c);
  }
  return chosen;
}

void MapJoiner::claim(std::vector<MapPart>& parts, Index claimant, int keyframe) {
  MapPart& own = parts[claimant];
  const Keyframe& scan = own.map.keyframes[Index(keyframe)];
  const Place own_place =
      placeOf(own.map, keyframe,
              connectedViews(own.map, keyframe, params_.loop.place_keyframes, params_), params_);
  for (const Candidate& c : candidates(parts, claimant, scan.features.primitives_in_body)) {
    MapPart& other = parts[c.part];
    const auto match =
        matchPlace(other.map, c.keyframe, scan.features, own_place.features, std::nullopt, params_);
    if (!match) continue;
    PlaceClaim claim = claimOf(other.map, *match, own.map, keyframe);
    claim.clarity = match->clarity;
    if (motionAllows(other, own, claim.map_a_from_map_b, params_)) {
      pool(other.id, own.id).add(claim);
    } else {
      refute(claim, other, own);
    }
  }
}

std::vector<PlaceClaim> MapJoiner::provenClaims(MapPart& host, MapPart& guest) {
  ClaimPool& claims = pool(host.id, guest.id);
  const double reach = params_.loop.search_distance;
  claims.forget([&](const PlaceClaim& claim) {
    return host.seesRepeated(claim.keyframe_a, reach) ||
           guest.seesRepeated(claim.keyframe_b, reach);
  });
  std::vector<PlaceClaim> agreed = claims.agreed();
  if (agreed.empty() ||
      conflictOf(viewsOf(host.map), viewsOf(guest.map), agreed.front().map_a_from_map_b, params_) <=
          params_.global_alignment.max_conflict)
    return agreed;
  for (const PlaceClaim& claim : agreed) refute(claim, host, guest);
  return {};
}

bool MapJoiner::joinAgreed(std::vector<MapPart>& parts, Index claimant) {
  for (Index p = 0; p < parts.size(); ++p) {
    MapPart &host = parts[p], &guest = parts[claimant];
    if (host.id >= guest.id) continue;
    const std::vector<PlaceClaim> claims = provenClaims(host, guest);
    if (claims.empty()) continue;
    const Eigen::Isometry3d host_from_guest = claims.front().map_a_from_map_b;
    const int first = static_cast<int>(host.map.keyframes.size());
    appendMap(host_from_guest, std::move(guest.map), host.map);
    for (PlaceClaim claim : claims) {
      claim.keyframe_b += first;
      tie(claim, params_.loop, host.map);
    }
    ++host.map.loop_closures;
    settleMap(host.map, 1, params_);
    host.indexFrom(Index(first));
    host.history.merge(guest.history);
    MapPart joined = std::move(host);
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(std::max(p, claimant)));
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(std::min(p, claimant)));
    parts.push_back(std::move(joined));
    return true;
  }
  return false;
}

bool MapJoiner::joinNewest(std::vector<MapPart>& parts) {
  if (parts.size() < 2 || !params_.loop.join_maps) return false;
  const Index newest = parts.size() - 1;
  const int keyframes = static_cast<int>(parts[newest].map.keyframes.size());
  claim(parts, newest, keyframes - 1);
  return keyframes >= params_.loop.early_keyframes && joinAgreed(parts, newest);
}

void MapJoiner::joinAll(std::vector<MapPart>& parts) {
  bool joined = params_.loop.join_maps && parts.size() > 1;
  while (joined) {
    joined = false;
    pools_.clear();
    // All claims before any join: a later one may show that a place is one of many alike.
    for (Index p = 0; p < parts.size(); ++p) {
      const int keyframes = static_cast<int>(parts[p].map.keyframes.size());
      const int step = 1 + keyframes / kClaimants;
      for (int k = 0; k < keyframes; k += step) claim(parts, p, k);
    }
    for (Index p = 0; p < parts.size() && !joined; ++p) joined = joinAgreed(parts, p);
  }
}

}  // namespace opp::mapping
