// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/loop/claim_pool.h"
#include "opp/mapping/loop/constellation.h"

#include <map>
#include <set>
#include <utility>
#include <vector>

namespace opp::mapping {

/// What motion says of how a part begins: the body's pose at its first scan relative to that at the
/// last scan before, of another part.
struct ExpectedBeginning {
  int session = 0;
  std::size_t last_scan = 0;   ///< ScanFeatures::scan_index
  std::size_t first_scan = 0;  ///< the same
  Eigen::Isometry3d last_from_first = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of (ω, v) in the axes of the last body frame
};

/// A map that grew on its own: a session, or what came after the body was lost.
struct MapPart {
  explicit MapPart(int part_id, const LoopParams& params)
      : id(part_id), origins({part_id}), index(params.word_width) {}
  int id;  ///< in the order of their beginnings; stays when others join it
  /// Ids of the maps that its keyframes grew in. Two parts of one map were compared as it grew,
  /// with more known than is now: they are not compared again.
  std::set<int> origins;
  std::vector<ExpectedBeginning> beginnings;
  MapState map;
  ConstellationIndex index;  ///< of all keyframes
};

/// Proves that two parts show the same place, and makes them one.
///
/// A keyframe of a part is compared with the keyframes of older parts that it resembles most; each
/// pose that is found is a claim. Parts are joined when several keyframes make the same claim
/// (ClaimPool), the keyframes of both do not stand in each other's free space under it, and the
/// body could have moved so in the time between. What is not proven stays apart.
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
  void claim(const std::vector<MapPart>& parts, std::size_t claimant, int keyframe);
  bool joinAgreed(std::vector<MapPart>& parts, std::size_t claimant);
  ClaimPool& pool(int part_a, int part_b);

  MapperParams params_;
  std::map<std::pair<int, int>, ClaimPool> pools_;  ///< by ids of the parts
};

/// How much two maps contradict each other if `a_from_b` is right: of the samples of keyframes with
/// a common view, conflicts with free space over agreements and conflicts; 1 if there is no common
/// view. At most `keyframes` of b, spread evenly, are looked at.
double conflictOf(const MapState& a, const MapState& b, const Eigen::Isometry3d& a_from_b,
                  int keyframes, const MapperParams& params);

}  // namespace opp::mapping
