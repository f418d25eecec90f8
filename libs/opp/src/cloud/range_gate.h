// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace opp {

/// Points about a viewpoint between two ranges, told without a root.
class RangeGate {
 public:
  /// Both inclusive [m].
  RangeGate(double least, double most)
      : least_(static_cast<float>(least * least)), most_(static_cast<float>(most * most)) {}

  /// False for points that are not finite: they compare false. Without branches.
  bool contains(const Eigen::Vector3f& about_viewpoint) const {
    const float squared = about_viewpoint.squaredNorm();
    return (squared >= least_) & (squared <= most_);
  }

 private:
  float least_, most_;  ///< squared [m²]
};

}  // namespace opp
