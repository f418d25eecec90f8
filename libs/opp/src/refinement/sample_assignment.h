// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/geometry/point_cloud.h"
#include "opp/geometry/point_moments.h"
#include "opp/refinement/refinement_params.h"

#include <cstddef>
#include <vector>

namespace opp {

/// A plane under refinement and what its samples add up to.
struct PlaneFit {
  Plane plane;
  double slack = 0.0;  ///< [m] misfit beyond the sensor's noise; gates are wide while it is large

  PointMoments moments;        ///< weights: robust × effective raw points / variance [1/m²]
  double robust_weight = 0.0;  ///< Σ ω, ω = Tukey's weight in (0, 1]
  double square_sum = 0.0;     ///< Σ ω r² [m²]
  double variance_sum = 0.0;   ///< Σ ω σ², σ: of a raw point [m²]
  int support = 0;             ///< samples

  /// Mean variance of a raw point on the plane [m²].
  double meanVariance() const { return robust_weight > 0.0 ? variance_sum / robust_weight : 0.0; }
  /// Standard deviation of the residuals beyond the sensor's noise [m]; 0 if it could be chance.
  double excess(double outlier_cutoff) const;
  void clearSums();
};

/// Planes that share one normal, to be searched by offset.
struct ParallelGroup {
  struct Member {
    double position = 0.0;  ///< of the plane along the group's normal [m]
    std::size_t plane = 0;
  };
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  std::vector<Member> members;  ///< ascending positions
};

/// Group of `planes` (indices into fits), all parallel to `normal`.
ParallelGroup makeGroup(const Eigen::Vector3d& normal, const std::vector<std::size_t>& planes,
                        const std::vector<PlaneFit>& fits);

/// Gives every `stride`-th sample to the nearest plane whose normal agrees, if it is no outlier
/// there, and sums it up in that plane's fit (IV-b (1), (2)). Labels of the other samples stay.
void assignSamples(const OrientedCloud& cloud, const std::vector<ParallelGroup>& groups,
                   const RefinementParams& params, std::size_t stride, std::vector<PlaneFit>& fits,
                   std::vector<int>& labels);

}  // namespace opp
