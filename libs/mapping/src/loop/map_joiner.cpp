// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/loop/map_joiner.h"

#include "opp/mapping/backend/settle_map.h"
#include "opp/mapping/loop/close_loops.h"
#include "opp/mapping/loop/join_maps.h"
#include "opp/mapping/loop/match_place.h"
#include "opp/mapping/loop/place.h"

#include "registration/scan_model.h"
#include "registration/verify_pose.h"

#include <algorithm>

namespace opp::mapping {
namespace {

using Index = std::size_t;

/// Keyframes of a part that are compared with the other before a join.
constexpr int kComparedKeyframes = 12;
/// Keyframes of a part that look for their places in the end, about.
constexpr int kClaimants = 40;

const LocalizedScan* scanOf(const MapState& map, int session, std::size_t scan_index) {
  const auto found = std::find_if(map.scans.begin(), map.scans.end(), [&](const LocalizedScan& s) {
    return s.session == session && s.scan_index == scan_index;
  });
  return found == map.scans.end() ? nullptr : &*found;
}

Eigen::Isometry3d poseOf(const MapState& map, const LocalizedScan& scan) {
  return map.keyframes[Index(scan.keyframe)].map_from_body * scan.keyframe_from_body;
}

/// Whether motion between the end of one part and the beginning of the other allows the pose.
bool expectedBy(const ExpectedBeginning& beginning, const MapState& a, const MapState& b,
                const Eigen::Isometry3d& a_from_b) {
  // The 99.9 % point of χ² with six degrees of freedom.
  constexpr double kPossible = 22.5;
  const LocalizedScan* last = scanOf(a, beginning.session, beginning.last_scan);
  const LocalizedScan* first = scanOf(b, beginning.session, beginning.first_scan);
  if (last == nullptr || first == nullptr) return true;
  const Eigen::Isometry3d last_from_first =
      poseOf(a, *last).inverse() * a_from_b * poseOf(b, *first);
  const Vector6d error = difference(beginning.last_from_first, last_from_first);
  return error.dot(beginning.information * error) <= kPossible;
}

/// The same for all beginnings of the two parts.
bool expectedToBe(const MapPart& a, const MapPart& b, const Eigen::Isometry3d& a_from_b) {
  const auto agree = [](const MapPart& earlier, const MapPart& later,
                        const Eigen::Isometry3d& earlier_from_later) {
    return std::all_of(later.beginnings.begin(), later.beginnings.end(),
                       [&](const auto& beginning) {
                         return expectedBy(beginning, earlier.map, later.map, earlier_from_later);
                       });
  };
  return agree(a, b, a_from_b) && agree(b, a, a_from_b.inverse());
}

bool haveCommon(const std::set<int>& a, const std::set<int>& b) {
  return std::any_of(a.begin(), a.end(), [&](int id) { return b.count(id) > 0; });
}

/// Whether the body can have got from the one part to the other: within a session it moves at most
/// at some times its typical speed.
bool reachable(const MapState& a, const MapState& b, const Eigen::Isometry3d& a_from_b,
               const MapperParams& params) {
  constexpr double kSigmas = 3.0;
  for (const LocalizedScan& first : b.scans) {
    const LocalizedScan* last = nullptr;
    for (const LocalizedScan& scan : a.scans) {
      if (scan.session == first.session && scan.timestamp <= first.timestamp) last = &scan;
    }
    if (last == nullptr) continue;
    const double seconds = first.timestamp - last->timestamp;
    const Eigen::Vector3d was = poseOf(a, *last).translation();
    const Eigen::Vector3d is = a_from_b * poseOf(b, first).translation();
    return (is - was).norm() <=
           params.loop.search_distance + kSigmas * params.frontend.speed * seconds;
  }
  return true;
}

/// The keyframe of `map` whose view is nearest to `view`; −1 if none is within `reach`.
int nearestView(const MapState& map, const Eigen::Vector3d& view, double reach) {
  int nearest = -1;
  for (Index k = 0; k < map.keyframes.size(); ++k) {
    const double distance = (map.keyframes[k].viewCentre() - view).norm();
    if (distance >= reach) continue;
    reach = distance;
    nearest = static_cast<int>(k);
  }
  return nearest;
}

}  // namespace

double conflictOf(const MapState& a, const MapState& b, const Eigen::Isometry3d& a_from_b,
                  int keyframes, const MapperParams& params) {
  const Index step = std::max<Index>(1, b.keyframes.size() / Index(keyframes));
  int agreeing = 0, conflicting = 0;
  for (Index k = 0; k < b.keyframes.size(); k += step) {
    const Keyframe& of_b = b.keyframes[k];
    const int near = nearestView(a, a_from_b * of_b.viewCentre(), params.loop.search_distance);
    if (near < 0) continue;
    const Keyframe& of_a = a.keyframes[Index(near)];
    const ScanModel target(of_a.features, params.primitives.sensor, params.global_alignment);
    const ScanModel source(of_b.features, params.primitives.sensor, params.global_alignment);
    const Eigen::Isometry3d target_from_source =
        of_a.map_from_body.inverse() * a_from_b * of_b.map_from_body;
    const Verification seen = verifyPose(target, source, target_from_source,
                                         params.loop.agree_translation, params.global_alignment);
    for (const Agreement* side : {&seen.of_source, &seen.of_target}) {
      agreeing += side->agreeing;
      conflicting += side->conflicting;
    }
  }
  const int both = agreeing + conflicting;
  return both == 0 ? 1.0 : static_cast<double>(conflicting) / both;
}

ClaimPool& MapJoiner::pool(int part_a, int part_b) {
  return pools_.try_emplace({part_a, part_b}, params_.loop).first->second;
}

std::vector<MapJoiner::Candidate> MapJoiner::candidates(const std::vector<MapPart>& parts,
                                                        Index claimant,
                                                        const Primitives& primitives) const {
  std::vector<Candidate> ranked;
  for (Index p = 0; p < parts.size(); ++p) {
    if (parts[p].id >= parts[claimant].id || haveCommon(parts[p].origins, parts[claimant].origins))
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

void MapJoiner::claim(const std::vector<MapPart>& parts, Index claimant, int keyframe) {
  const MapPart& own = parts[claimant];
  const Keyframe& scan = own.map.keyframes[Index(keyframe)];
  const Place own_place =
      placeOf(own.map, keyframe,
              connectedViews(own.map, keyframe, params_.loop.place_keyframes, params_), params_);
  for (const Candidate& c : candidates(parts, claimant, scan.features.primitives_in_body)) {
    const MapPart& other = parts[c.part];
    const auto match =
        matchPlace(other.map, c.keyframe, scan.features, own_place.features, std::nullopt, params_);
    if (!match) continue;
    PlaceClaim claim = claimOf(other.map, *match, own.map, keyframe);
    claim.clarity = match->clarity;
    if (reachable(other.map, own.map, claim.map_a_from_map_b, params_) &&
        expectedToBe(other, own, claim.map_a_from_map_b))
      pool(other.id, own.id).add(claim);
  }
}

bool MapJoiner::joinAgreed(std::vector<MapPart>& parts, Index claimant) {
  for (Index p = 0; p < parts.size(); ++p) {
    MapPart &host = parts[p], &guest = parts[claimant];
    if (host.id >= guest.id) continue;
    const std::vector<PlaceClaim> claims = pool(host.id, guest.id).agreed();
    if (claims.empty()) continue;
    const Eigen::Isometry3d host_from_guest = claims.front().map_a_from_map_b;
    if (conflictOf(host.map, guest.map, host_from_guest, kComparedKeyframes, params_) >
        params_.global_alignment.max_conflict) {
      continue;
    }
    const int first = static_cast<int>(host.map.keyframes.size());
    appendMap(host_from_guest, std::move(guest.map), host.map);
    for (PlaceClaim claim : claims) {
      claim.keyframe_b += first;
      tie(claim, params_.loop, host.map);
    }
    ++host.map.loop_closures;
    settleMap(host.map, 1, params_);
    for (Index k = Index(first); k < host.map.keyframes.size(); ++k)
      host.index.add(host.map.keyframes[k].features.primitives_in_body);
    host.origins.insert(guest.origins.begin(), guest.origins.end());
    host.beginnings.insert(host.beginnings.end(), guest.beginnings.begin(), guest.beginnings.end());
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
    for (Index p = 0; p < parts.size() && !joined; ++p) {
      const int keyframes = static_cast<int>(parts[p].map.keyframes.size());
      const int step = 1 + keyframes / kClaimants;
      for (int k = 0; k < keyframes; k += step) claim(parts, p, k);
      joined = joinAgreed(parts, p);
    }
  }
}

}  // namespace opp::mapping
