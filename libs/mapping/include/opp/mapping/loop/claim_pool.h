// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/scan_features.h"
#include "opp/mapping/core/se3.h"
#include "opp/mapping/loop/loop_params.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace opp::mapping {

/// One keyframe's claim to stand at a place that another keyframe saw.
struct PlaceClaim {
  int keyframe_a = 0;
  int keyframe_b = 0;
  Eigen::Isometry3d keyframe_a_from_b = Eigen::Isometry3d::Identity();  ///< as measured
  double variance = 0.0;  ///< of keyframe b's view, worst direction, see `viewVariance` [m²]
  Matrix6d information = Matrix6d::Zero();  ///< of it, see PlaceMatch
  /// What follows for the frames in which the poses of a and b are given: two maps, or a map before
  /// and after it drifted.
  Eigen::Isometry3d map_a_from_map_b = Eigen::Isometry3d::Identity();
  Eigen::Vector3d place_in_map_b = Eigen::Vector3d::Zero();  ///< where the claim was made [m]
  double clarity = 0.0;                                      ///< see PlaceMatch
  ScanId claimant;                                           ///< the keyframe that looked: a or b
  bool b_looked = true;                                      ///< `claimant` is keyframe b
};

/// The same claim with a and b swapped; the variance is taken to be that of a's view, too.
PlaceClaim seenFromOther(const PlaceClaim& claim);

/// How many different keyframes of one of the two frames claim these, whichever has more: two that
/// look at each other's places see the same likeness.
std::size_t claimantsOf(const std::vector<PlaceClaim>& claims);

/// Claims about the same two frames, waiting for enough of them to agree. A single scan can fit at
/// a wrong place; different keyframes that were tracked apart rarely fit at wrong places that
/// agree.
class ClaimPool {
 public:
  /// \param confirmations different keyframes that must agree
  /// \param one_may_do whether one that is as clear as `certain_clarity` is enough
  ClaimPool(const LoopParams& params, int confirmations, bool one_may_do = true)
      : params_(params), confirmations_(confirmations), one_may_do_(one_may_do) {}

  void add(const PlaceClaim& claim) { claims_.push_back(claim); }
  /// Drops the claims for which `unwanted` is true.
  template <typename Predicate>
  void forget(const Predicate& unwanted) {
    claims_.erase(std::remove_if(claims_.begin(), claims_.end(), unwanted), claims_.end());
  }
  void clear() { claims_.clear(); }
  bool empty() const { return claims_.empty(); }

  /// The claims that at least `confirmations` different keyframes agree on. O(claims²).
  std::vector<PlaceClaim> confirmed() const;

  /// The claims of the pose that most different keyframes agree on, if these are at least
  /// `confirmations` (or one is certain, see the constructor) and `rival_ratio` times as many as
  /// agree on any other; else empty: not proven, or ambiguous. O(claims²).
  std::vector<PlaceClaim> agreed() const;

 private:
  friend struct StateAccess;  // checkpoints
  bool agree(const PlaceClaim& x, const PlaceClaim& y) const;
  /// The claim, and those of `claims` that agree with it.
  std::vector<PlaceClaim> groupOf(const PlaceClaim& claim,
                                  const std::vector<PlaceClaim>& claims) const;
  std::vector<PlaceClaim> largestGroup(const std::vector<PlaceClaim>& claims) const;
  LoopParams params_;
  int confirmations_;
  bool one_may_do_;
  std::vector<PlaceClaim> claims_;
};

}  // namespace opp::mapping
