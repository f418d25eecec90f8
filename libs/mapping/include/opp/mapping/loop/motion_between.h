// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/loop/map_part.h"

#include <cstddef>
#include <vector>

namespace opp::mapping {

/// What motion says of where two parts lie in each other: within a session the body moves at most
/// at some times its typical speed, each time that it went from the one part to the other, and
/// begins a part where it was expected (PartHistory::beginnings). Where a third part came between,
/// the two expectations are chained through it.
class MotionBetween {
 public:
  /// Of parts[a] and parts[b]. O(scans · (log scans + beginnings)).
  MotionBetween(const std::vector<MapPart>& parts, std::size_t a, std::size_t b,
                const MapperParams& params);

  /// Whether motion says anything: not of parts of different sessions.
  bool isKnown() const { return !passages_.empty() || !expectations_.empty(); }

  /// Whether the body can have moved so if `a_from_b` is right. O(passages + beginnings).
  bool allows(const Eigen::Isometry3d& a_from_b) const;

  /// Whether it is where the body was expected, and that to within `LoopParams::search_distance`:
  /// what motion says then is evidence of its own. O(beginnings).
  bool expects(const Eigen::Isometry3d& a_from_b) const;

 private:
  /// The body went from one part to the other.
  struct Passage {
    Eigen::Vector3d position_in_a;
    Eigen::Vector3d position_in_b;
    double reach;  ///< it can have got so far [m]
  };
  /// The one part ended, and the other began, at these poses, each in its own map.
  struct Expectation {
    ExpectedBeginning beginning;
    bool begins_b;  ///< else the later part is `a`
    Eigen::Isometry3d earlier_from_last;
    Eigen::Isometry3d later_from_first;
  };

  void addPassages(const MapState& a, const MapState& b, const MapperParams& params);
  void addExpectations(const std::vector<MapPart>& parts, std::size_t earlier, std::size_t later,
                       bool begins_b);

  bool isMet(const Expectation& expectation, const Eigen::Isometry3d& a_from_b) const;

  Vector6d tolerance_;      ///< variances of a claim's (ω, v)
  double search_distance_;  ///< [m]
  std::vector<Passage> passages_;
  std::vector<Expectation> expectations_;
};

}  // namespace opp::mapping
