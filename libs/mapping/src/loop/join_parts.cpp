// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/join_parts.h"

#include "opp/mapping/backend/settle_map.h"
#include "opp/mapping/loop/claim_pool.h"
#include "opp/mapping/loop/close_loops.h"
#include "opp/mapping/loop/join_maps.h"
#include "opp/mapping/loop/map_conflict.h"
#include "opp/mapping/loop/match_place.h"
#include "opp/mapping/loop/motion_between.h"
#include "opp/mapping/loop/place.h"
#include "opp/parallel/parallel_for.h"

#include "loop/choose_keyframes.h"
#include "loop/fits_another_way.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// A claim about two parts, by their indices; `a` comes before `b`.
struct PartClaim {
  Index a = 0, b = 0;
  PlaceClaim claim;
};

/// Claims about two parts that agree.
struct SharedClaim {
  Index a = 0, b = 0;
  std::vector<PlaceClaim> claims;

  const Eigen::Isometry3d& a_from_b() const { return claims.front().map_a_from_map_b; }
  /// Pose of the other part in this one.
  Eigen::Isometry3d from(Index part) const { return part == a ? a_from_b() : a_from_b().inverse(); }
  bool isAbout(const PartClaim& c) const { return c.a == a && c.b == b; }
};

class Joiner {
 public:
  Joiner(std::vector<MapPart>& parts, const MapperParams& params)
      : parts_(parts), params_(params) {}

  void run(int threads) {
    std::vector<std::pair<Index, int>> claimants;
    for (Index p = 0; p < parts_.size(); ++p) {
      const int keyframes = static_cast<int>(parts_[p].map.keyframes.size());
      for (int k = 0; k < keyframes; k += claimantStep(keyframes)) claimants.emplace_back(p, k);
    }
    std::vector<std::vector<PartClaim>> claims(claimants.size());
    parallelFor(claimants.size(), threads,
                [&](Index i) { claims[i] = claimsOf(claimants[i].first, claimants[i].second); });
    for (const auto& some : claims) claims_.insert(claims_.end(), some.begin(), some.end());
    while (joinBest()) {
    }
  }

 private:
  struct Candidate {
    double likeness;
    Index part;
    int keyframe;
  };

  /// Keyframes of other parts that resemble the scan most, each at a place of its own.
  std::vector<Candidate> candidates(Index claimant, const Primitives& primitives) const {
    std::vector<Candidate> ranked;
    for (Index p = 0; p < parts_.size(); ++p) {
      if (p == claimant || parts_[p].history.sharesOrigin(parts_[claimant].history)) continue;
      const std::vector<double> likeness = parts_[p].index.likeness(primitives);
      for (Index k = 0; k < likeness.size(); ++k) {
        ranked.push_back({likeness[k], p, static_cast<int>(k)});
      }
    }
    std::stable_sort(ranked.begin(), ranked.end(), [](const Candidate& x, const Candidate& y) {
      return x.likeness > y.likeness;
    });
    return distinctPlaces(
        ranked, Index(params_.loop.max_candidates), [&](const Candidate& x, const Candidate& y) {
          return x.part != y.part ||
                 (viewOf(x) - viewOf(y)).norm() > 0.5 * params_.loop.search_distance;
        });
  }

  Eigen::Vector3d viewOf(const Candidate& c) const {
    return parts_[c.part].map.keyframes[Index(c.keyframe)].viewCentre();
  }

  /// What one keyframe claims.
  std::vector<PartClaim> claimsOf(Index part, int keyframe) const {
    const MapState& own = parts_[part].map;
    const ScanFeatures& scan = own.keyframes[Index(keyframe)].features;
    const std::vector<Candidate> places = candidates(part, scan.primitives_in_body);
    if (places.empty()) return {};
    std::vector<PartClaim> claims;
    const Place own_place =
        placeOf(own, keyframe, connectedViews(own, keyframe, params_.loop.place_keyframes, params_),
                params_);
    for (const Candidate& c : places) {
      const MapState& other = parts_[c.part].map;
      const auto match =
          matchPlace(other, c.keyframe, scan, own_place.features, std::nullopt, params_);
      if (!match) continue;
      PlaceClaim claim = claimOf(other, *match, own, keyframe);
      claim.clarity = match->clarity;
      if (c.part < part)
        claims.push_back({c.part, part, claim});
      else
        claims.push_back({part, c.part, seenFromOther(claim)});
    }
    return claims;
  }

  /// As the parts are until the next two are joined.
  const MotionBetween& motionBetween(Index a, Index b) const {
    return motions_.try_emplace({a, b}, parts_, a, b, params_).first->second;
  }

  /// The place was recognized where it cannot be.
  void refute(const PartClaim& c) {
    parts_[c.a].markRepeated(c.claim.keyframe_a);
    parts_[c.b].markRepeated(c.claim.keyframe_b);
  }

  template <typename Predicate>
  void drop(const Predicate& unwanted) {
    claims_.erase(std::remove_if(claims_.begin(), claims_.end(), unwanted), claims_.end());
  }

  /// Drops what motion denies, and then all claims about places that have others like them, but for
  /// those where motion tells which of them it is. As many keyframes must mistake a place as would
  /// have to recognize it: one that is deceived tells more of itself than of the place.
  void dropRefuted() {
    std::map<std::pair<Index, Index>, ClaimPool> denied;
    drop([&](const PartClaim& c) {
      if (motionBetween(c.a, c.b).allows(c.claim.map_a_from_map_b)) return false;
      denied.try_emplace({c.a, c.b}, params_.loop, params_.loop.confirmations)
          .first->second.add(c.claim);
      return true;
    });
    for (const auto& [between, pool] : denied) {
      for (const PlaceClaim& claim : pool.confirmed())
        refute({between.first, between.second, claim});
    }
    const double reach = params_.loop.search_distance;
    drop([&](const PartClaim& c) {
      if (motionBetween(c.a, c.b).expects(c.claim.map_a_from_map_b)) return false;
      return parts_[c.a].seesRepeated(c.claim.keyframe_a, reach) ||
             parts_[c.b].seesRepeated(c.claim.keyframe_b, reach);
    });
  }

  bool conflicts(const SharedClaim& agreement) const {
    return conflictOf(viewsOf(parts_[agreement.a].map), viewsOf(parts_[agreement.b].map),
                      agreement.a_from_b(), params_)
               .value_or(1.0) > params_.global_alignment.max_conflict;
  }

  /// Whether these, at least one, are about one keyframe of one of the two parts.
  static bool isOneView(const std::vector<PlaceClaim>& claims) {
    const auto allShare = [&](int PlaceClaim::*keyframe) {
      return std::all_of(claims.begin(), claims.end(), [&](const PlaceClaim& c) {
        return c.*keyframe == claims.front().*keyframe;
      });
    };
    return allShare(&PlaceClaim::keyframe_a) || allShare(&PlaceClaim::keyframe_b);
  }

  /// What enough keyframes claim of two parts: fewer where motion says the same, more where it
  /// could and does not. One that is certain is certain of the kind of place only; within a
  /// session, motion must tell that it is this one.
  std::vector<PlaceClaim> agreed(Index a, Index b, const std::vector<PlaceClaim>& claims) const {
    const auto agreedBy = [&](int confirmations, bool one_may_do) {
      ClaimPool pool(params_.loop, confirmations, one_may_do);
      for (const PlaceClaim& c : claims) pool.add(c);
      return pool.agreed();
    };
    const MotionBetween& motion = motionBetween(a, b);
    if (!motion.isKnown()) return agreedBy(params_.loop.join_confirmations, true);
    std::vector<PlaceClaim> result = agreedBy(params_.loop.revisit_confirmations, false);
    if (!result.empty()) return result;
    result = agreedBy(params_.loop.confirmations, true);
    // A part of one keyframe is one view, and several that look there next to each other see it
    // alike: where motion could tell and leaves much open, more of them must.
    if (!result.empty() && isOneView(result))
      result = agreedBy(params_.loop.join_confirmations, true);
    if (!result.empty() && !motion.expects(result.front().map_a_from_map_b)) result.clear();
    return result;
  }

  /// What is claimed of each two parts, what most keyframes claim first.
  std::vector<SharedClaim> agreements() const {
    std::map<std::pair<Index, Index>, std::vector<PlaceClaim>> claims;
    for (const PartClaim& c : claims_) claims[{c.a, c.b}].push_back(c.claim);
    std::vector<SharedClaim> result;
    for (const auto& [between, about] : claims) {
      std::vector<PlaceClaim> shared = agreed(between.first, between.second, about);
      if (!shared.empty()) result.push_back({between.first, between.second, std::move(shared)});
    }
    std::stable_sort(result.begin(), result.end(), [](const SharedClaim& x, const SharedClaim& y) {
      return claimantsOf(x.claims) > claimantsOf(y.claims);
    });
    return result;
  }

  /// Whether motion denies that both are right: each may agree with it, but not what follows of the
  /// two parts that only one of them is about.
  bool exclude(const SharedClaim& x, const SharedClaim& y) const {
    for (const Index shared : {x.a, x.b}) {
      if (shared != y.a && shared != y.b) continue;
      const Index p = x.a + x.b - shared, q = y.a + y.b - shared;
      if (p == q) return false;
      return !motionBetween(p, q).allows(x.from(shared).inverse() * y.from(shared));
    }
    return false;
  }

  /// The claims of most keyframes that nothing denies.
  std::optional<SharedClaim> best() {
    for (;;) {
      dropRefuted();
      const std::vector<SharedClaim> all = agreements();
      if (all.empty()) return std::nullopt;
      const SharedClaim& first = all.front();
      if (conflicts(first)) {
        for (const PlaceClaim& claim : first.claims) refute({first.a, first.b, claim});
        continue;
      }
      if (fitsAnotherWay(parts_[first.a].map, parts_[first.b].map, first.claims,
                         motionBetween(first.a, first.b), params_)) {
        drop([&](const PartClaim& c) { return first.isAbout(c); });
        continue;
      }
      const auto rival = std::find_if(all.begin() + 1, all.end(), [&](const SharedClaim& other) {
        return static_cast<double>(claimantsOf(first.claims)) <
                   params_.loop.rival_ratio * static_cast<double>(claimantsOf(other.claims)) &&
               exclude(first, other);
      });
      if (rival == all.end()) return first;
      // One of them is wrong, and nothing tells which.
      drop([&](const PartClaim& c) { return first.isAbout(c) || rival->isAbout(c); });
    }
  }

  bool joinBest() {
    const std::optional<SharedClaim> agreement = best();
    if (!agreement) return false;
    const auto& [a, b, claims] = *agreement;
    MapPart &host = parts_[a], &guest = parts_[b];
    const int first = static_cast<int>(host.map.keyframes.size());
    appendMap(agreement->a_from_b(), std::move(guest.map), host.map);
    for (PlaceClaim claim : claims) {
      claim.keyframe_b += first;
      tie(claim, params_.loop, host.map);
    }
    ++host.map.loop_closures;
    settleMap(host.map, 1, params_);
    host.indexFrom(Index(first));
    host.history.merge(guest.history);
    parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(b));
    motions_.clear();
    renumber(a, b, first);
    return true;
  }

  /// Part `b` became part of `a`, its keyframes from `first` on.
  void renumber(Index a, Index b, int first) {
    const auto follow = [&](Index& part, int& keyframe) {
      if (part == b) {
        part = a;
        keyframe += first;
      } else if (part > b) {
        --part;
      }
    };
    for (PartClaim& c : claims_) {
      follow(c.a, c.claim.keyframe_a);
      follow(c.b, c.claim.keyframe_b);
      if (c.a > c.b) {
        std::swap(c.a, c.b);
        c.claim = seenFromOther(c.claim);
      }
      relate(parts_[c.a].map, parts_[c.b].map, c.claim);
    }
    drop([](const PartClaim& c) { return c.a == c.b; });
  }

  std::vector<MapPart>& parts_;
  const MapperParams& params_;
  std::vector<PartClaim> claims_;
  mutable std::map<std::pair<Index, Index>, MotionBetween> motions_;  ///< see `motionBetween`
};

}  // namespace

void joinParts(std::vector<MapPart>& parts, const MapperParams& params, int threads) {
  if (params.loop.join_maps && parts.size() > 1) Joiner(parts, params).run(threads);
}

}  // namespace opp::mapping
