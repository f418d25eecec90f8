// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/detection/detect_opps.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace opp {

/// For each hypothesis the index of the strongest one that is the same plane (its leader): each
/// one's anchor lies within the resolution of the other's plane (of both the lesser), and
/// the normals differ by less than `angle` [rad], signs aside. Sommer et al. 2020, III-c.
/// O(hypotheses × leaders).
struct GatheredHypotheses {
  std::vector<std::size_t> leader_of;
  std::vector<std::size_t> leaders;  ///< in descending order of votes
  /// Per leader: where the samples of its hypotheses are.
  std::vector<Eigen::AlignedBox3f> boxes;
};
GatheredHypotheses gatherHypotheses(const std::vector<PlaneHypothesis>& hypotheses, double angle);

}  // namespace opp
