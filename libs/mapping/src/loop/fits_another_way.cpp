// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop/fits_another_way.h"

#include "opp/mapping/loop/map_conflict.h"
#include "opp/mapping/registration/align_globally.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <set>

namespace opp::mapping {
namespace {

/// Whether a pose with such a conflict is as good as one without: a sample that agrees at the one
/// and conflicts at the other tells by two votes among those that both see (see `clarity`). What
/// only one of them sees, as between the beams of a lidar, tells nothing.
bool isAsGood(double conflict, const MapperParams& params) {
  return std::sqrt(2.0 * conflict) < params.global_alignment.min_clarity;
}

bool fits(const AlignmentHypothesis& pose, const MapperParams& params) {
  return pose.overlap >= params.global_alignment.min_overlap && isAsGood(pose.conflict, params);
}

/// Motions of the map that leave what a keyframe saw as it looks.
std::vector<Eigen::Isometry3d> symmetriesAt(const Keyframe& keyframe, const MapperParams& params) {
  const GlobalAlignment alignment = alignGlobally(
      keyframe.features, keyframe.features, params.primitives.sensor, params.global_alignment);
  std::vector<Eigen::Isometry3d> result;
  for (const AlignmentHypothesis& h : alignment.hypotheses) {
    const Eigen::Isometry3d& moved_from_body = h.target_from_source;
    const Eigen::Vector3d& view = keyframe.view_centre_in_body;
    const bool moves = rotationAngle(moved_from_body) > params.global_alignment.distinct_rotation ||
                       (moved_from_body * view - view).norm() > params.loop.agree_translation;
    if (moves && fits(h, params))
      result.push_back(keyframe.map_from_body * moved_from_body * keyframe.map_from_body.inverse());
  }
  return result;
}

/// Two maps, and what is claimed of them.
struct Claimed {
  const MapState& a;
  const MapState& b;
  const std::vector<PlaceClaim>& claims;
  const MotionBetween& motion;
  const MapperParams& params;

  const Keyframe& keyframeA(const PlaceClaim& claim) const {
    return a.keyframes[static_cast<std::size_t>(claim.keyframe_a)];
  }
  const Keyframe& keyframeB(const PlaceClaim& claim) const {
    return b.keyframes[static_cast<std::size_t>(claim.keyframe_b)];
  }

  /// Whether the keyframes of a claim fit at another pose of the maps.
  bool fitAt(const Eigen::Isometry3d& a_from_b, const PlaceClaim& claim) const {
    const Keyframe &of_a = keyframeA(claim), &of_b = keyframeB(claim);
    const GlobalAlignment judged = judgePose(
        of_a.features, of_b.features, of_a.map_from_body.inverse() * a_from_b * of_b.map_from_body,
        params.primitives.sensor, params.global_alignment);
    return !judged.hypotheses.empty() && fits(judged.hypotheses.front(), params);
  }

  /// Whether half of those who claim a pose would fit at another, or more, and neither motion nor
  /// the rest of the maps tells the two apart.
  bool haveRival(const Eigen::Isometry3d& a_from_b) const {
    const bool expected = motion.expects(claims.front().map_a_from_map_b);
    if (expected ? !motion.expects(a_from_b) : !motion.allows(a_from_b)) return false;
    const auto conflict = conflictOf(viewsOf(a), viewsOf(b), a_from_b, params);
    if (conflict && !isAsGood(*conflict, params)) return false;
    std::vector<PlaceClaim> fitting;
    std::copy_if(claims.begin(), claims.end(), std::back_inserter(fitting),
                 [&](const PlaceClaim& claim) { return fitAt(a_from_b, claim); });
    return static_cast<double>(claimantsOf(claims)) <
           params.loop.rival_ratio * static_cast<double>(claimantsOf(fitting));
  }
};

}  // namespace

bool fitsAnotherWay(const MapState& a, const MapState& b, const std::vector<PlaceClaim>& claims,
                    const MotionBetween& motion, const MapperParams& params) {
  const Claimed claimed{a, b, claims, motion, params};
  const Eigen::Isometry3d& a_from_b = claims.front().map_a_from_map_b;
  std::set<int> asked_a, asked_b;
  for (const PlaceClaim& claim : claims) {
    if (asked_a.insert(claim.keyframe_a).second) {
      for (const Eigen::Isometry3d& s : symmetriesAt(claimed.keyframeA(claim), params))
        if (claimed.haveRival(s * a_from_b)) return true;
    }
    if (asked_b.insert(claim.keyframe_b).second) {
      for (const Eigen::Isometry3d& s : symmetriesAt(claimed.keyframeB(claim), params))
        if (claimed.haveRival(a_from_b * s)) return true;
    }
  }
  return false;
}

}  // namespace opp::mapping
