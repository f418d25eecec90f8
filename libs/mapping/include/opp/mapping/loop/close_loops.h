// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/loop/claim_pool.h"

#include <vector>

namespace opp::mapping {

/// Links the newest keyframe to the keyframes that it was matched against, with the drift that is
/// expected between them and what the match left open.
/// \param matched ids of the local map's keyframes; \param covariance of the match, see MatchResult
void linkKeyframe(const std::vector<int>& matched, const Matrix6d& covariance,
                  const LoopParams& params, MapState& map);

/// Adds what a claim says of two keyframes to the map's factors and links.
void tie(const PlaceClaim& claim, const LoopParams& params, MapState& map);

/// Recognizes places of a map that its newest keyframe has come back to.
///
/// Candidates are keyframes that are near by the map's own estimate, as far as its drift since then
/// allows, but whose relative pose is not known well enough to match them as one surface. A loop is
/// closed when several keyframes have found the same correction (ClaimPool); the map is then
/// optimized as a whole, and a loop that the optimization does not believe is taken out again.
class LoopCloser {
 public:
  explicit LoopCloser(const MapperParams& params)
      : params_(params), claims_(params.loop, params.loop.confirmations) {}

  /// True if a loop was closed: poses of all keyframes may have changed.
  bool close(MapState& map);
  /// Forgets what was not confirmed, as ids of keyframes change their meaning.
  void reset() { claims_.clear(); }

 private:
  friend struct StateAccess;  // checkpoints
  MapperParams params_;
  ClaimPool claims_;
};

/// Ties `keyframe_b` of each claim to its `keyframe_a`, optimizes the whole map and joins
/// landmarks. Claims that disagree with the result are taken out again, all of them if less are
/// left than were needed; then the map is as before. Returns how many stay.
int acceptClaims(const std::vector<PlaceClaim>& claims, const MapperParams& params, MapState& map);

}  // namespace opp::mapping
