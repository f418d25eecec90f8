// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/evaluation/primitive_error.h"
#include "opp/mapping/evaluation/primitive_tally.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace opp::mapping {

/// A true and an estimated element that pass all bounds.
struct PrimitiveCandidate {
  std::size_t gt = 0;  ///< indices into the map
  std::size_t est = 0;
  double angle = 0.0;     ///< [rad]
  double distance = 0.0;  ///< [m]
  double cost = 0.0;
};

/// One-to-one matches of one kind of primitive.
struct PrimitiveMatching {
  PrimitiveTally tally;
  std::vector<int> gt_of_est;  ///< the true element that an estimated one is matched to; −1: none
};

/// Matches one to one and tallies.
/// \param gt_sizes of the true elements (see PrimitiveTally::gt_size), one for each.
/// \param barely_seen pairs of elements of BarelySeen and estimated ones that are the same.
/// \param same_in_truth whether two true elements lie on one and the same plane or line.
PrimitiveMatching matchPrimitives(
    const std::vector<double>& gt_sizes, std::size_t est_count,
    const std::vector<PrimitiveCandidate>& candidates,
    const std::vector<PrimitiveCandidate>& barely_seen,
    const std::function<bool(std::size_t, std::size_t)>& same_in_truth);

struct PlaneMatching : PrimitiveMatching {
  /// The true plane, barely seen ones included, that each estimated one is or is a part of.
  std::vector<const PlanarMapPlane*> truth_of_est;
};

PlaneMatching matchPlanes(const PlanarMap& gt, const PlanarMap& est,
                          const PrimitiveErrorParams& params);
PrimitiveMatching matchLines(const PlanarMap& gt, const PlanarMap& est,
                             const PrimitiveErrorParams& params);
PrimitiveMatching matchCorners(const PlanarMap& gt, const PlanarMap& est,
                               const PrimitiveErrorParams& params);

/// Whether two extents (areas or lengths) of sizes `gt` and `est` that share `shared` are of the
/// same element.
inline bool extentsAgree(double gt, double est, double shared, const PrimitiveErrorParams& params) {
  return shared >= params.min_overlap * (gt < est ? gt : est) && shared >= params.min_coverage * gt;
}

/// Bounds within which true elements are one and the same plane or line. Truth is exact up to the
/// digits of its file, so these are far below any measurement.
inline constexpr double kSameAngle = 1e-3;     ///< [rad]
inline constexpr double kSameDistance = 1e-3;  ///< [m]

}  // namespace opp::mapping
