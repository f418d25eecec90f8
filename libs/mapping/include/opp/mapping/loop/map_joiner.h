// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/loop/claim_pool.h"
#include "opp/mapping/loop/map_part.h"

#include <map>
#include <utility>
#include <vector>

namespace opp::mapping {

/// Proves that two parts show the same place, and makes them one.
///
/// A keyframe of a part is compared with the keyframes of older parts that it resembles most; each
/// pose that is found is a claim. Parts are joined when several keyframes make the same claim
/// (ClaimPool), the keyframes of both do not stand in each other's free space under it, and the
/// body could have moved so in the time between. A place that is recognized where one of these says
/// that it cannot be has others like it, and proves nothing (PartHistory::repeated). What is not
/// proven stays apart.
class MapJoiner {
 public:
  explicit MapJoiner(const MapperParams& params) : params_(params) {}

  /// With the newest keyframe of the last part. True if that part became part of an older one,
  /// which then stands last.
  bool joinNewest(std::vector<MapPart>& parts);
  /// With some tens of keyframes of each part, spread evenly, when no more will come.
  void joinAll(std::vector<MapPart>& parts);

 private:
  struct Candidate {
    double likeness;
    std::size_t part;
    int keyframe;
  };
  std::vector<Candidate> candidates(const std::vector<MapPart>& parts, std::size_t claimant,
                                    const Primitives& primitives) const;
  void claim(std::vector<MapPart>& parts, std::size_t claimant, int keyframe);
  std::vector<PlaceClaim> provenClaims(MapPart& host, MapPart& guest);
  bool joinAgreed(std::vector<MapPart>& parts, std::size_t claimant);
  ClaimPool& pool(int part_a, int part_b);

  MapperParams params_;
  std::map<std::pair<int, int>, ClaimPool> pools_;  ///< by ids of the parts
};

}  // namespace opp::mapping
