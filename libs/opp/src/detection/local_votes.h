// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/detection/vote_table.h"

#include "detection/partners.h"
#include "detection/voting_scene.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace opp {

/// What the pairs of one reference point vote for. Reused for the next one.
class LocalVotes {
 public:
  explicit LocalVotes(const VotingScene& scene);

  /// Draws partners of sample `r` and tests the pairs (Eq. 2). Fills `partners`, `pairs` and
  /// `coplanar`.
  void pairUp(std::uint32_t r);
  /// Casts the orthogonal votes of these pairs (Eq. 3 and 4) into `table`; a voter is an index into
  /// `partners`. `tangents`: first two rows of R_z, transposed.
  void castOrthogonal(const Eigen::Matrix<float, 3, 2>& tangents);

  Partners partners;
  Partners coplanar;
  VoteTable table;
  std::size_t pairs = 0;  ///< partners within the radius

 private:
  const VotingScene& scene_;
  std::vector<NeighbourhoodGrid::Range> cells_;
  std::vector<std::int32_t> kinds_;   ///< per partner
  std::vector<float> thetas_;         ///< per partner
  std::vector<Eigen::Index> chosen_;  ///< scratch
};

}  // namespace opp
