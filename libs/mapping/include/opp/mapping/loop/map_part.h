// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/loop/constellation.h"

#include <cstddef>
#include <set>
#include <utility>
#include <vector>

namespace opp::mapping {

/// What motion says of how a part begins: the body's pose at its first scan relative to that at the
/// last scan before, of another part. Or what tied two keyframes of a map before it was split
/// between them, too loosely to hold it together.
struct ExpectedBeginning {
  ScanId last;
  ScanId first;
  Eigen::Isometry3d last_from_first = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of (ω, v) in the axes of the last body frame
};

/// What is known of a part beside its map.
struct PartHistory {
  /// Ids of the maps that its keyframes grew in. Two parts of one map were compared as it grew,
  /// with more known than is now: they are not compared again.
  std::set<int> origins;
  std::vector<ExpectedBeginning> beginnings;
  /// Keyframes whose place looks like another: it was recognized where it cannot be. To recognize
  /// it proves nothing.
  std::set<ScanId> repeated;

  bool sharesOrigin(const PartHistory& other) const;
  void merge(const PartHistory& other);
  /// Once for each two scans.
  void expect(const ExpectedBeginning& beginning);
  /// Keeps what ties the sets of keyframes (see `tiedSets`) that `map` is to be split into.
  void expectTied(const MapState& map, const std::vector<int>& sets);
};

/// A map that grew on its own: a session, or what came after the body was lost.
struct MapPart {
  explicit MapPart(int part_id, const LoopParams& params)
      : id(part_id), history{{part_id}, {}, {}}, index(params.word_width) {}

  /// Makes the map's keyframes from the given one on known to the index.
  void indexFrom(std::size_t first_keyframe);
  /// Whether the keyframe sees a place of PartHistory::repeated: one within `reach` of its view
  /// [m].
  bool seesRepeated(int keyframe, double reach) const;
  void markRepeated(int keyframe);

  int id;  ///< in the order of their beginnings; stays when others join it
  PartHistory history;
  MapState map;
  ConstellationIndex index;  ///< of all keyframes
};

}  // namespace opp::mapping
