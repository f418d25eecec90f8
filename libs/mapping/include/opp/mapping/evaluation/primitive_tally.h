// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/evaluation/statistics.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace opp::mapping {

/// Matches of one kind of primitive, in one scene or added up over many.
struct PrimitiveTally {
  std::size_t gt = 0;           ///< true elements
  std::size_t est = 0;          ///< estimated elements
  std::size_t gt_found = 0;     ///< true elements that were found
  std::size_t est_correct = 0;  ///< estimated elements that are a true one
  /// Estimated elements that are rather a true one which was barely seen than any that was seen
  /// well: neither right nor wrong.
  std::size_t est_neutral = 0;
  double gt_size = 0.0;        ///< of all true elements: pixels of planes, metres of lines
  double gt_size_found = 0.0;  ///< of those that were found
  std::vector<double> angles;  ///< of each matched pair [rad]
  /// Of each matched pair [m]: planes: offset at the true centroid; lines and corners: distance.
  std::vector<double> distances;
  std::vector<double> near_distances;  ///< those of corners near the sensor; see near_range

  /// est_correct / (est − est_neutral); nothing if nothing was estimated that counts.
  std::optional<double> precision() const;
  /// gt_found / gt; nothing if nothing is true.
  std::optional<double> recall() const;
  /// gt_size_found / gt_size: recall where each element weighs as much as was seen of it; nothing
  /// if nothing with a size is true.
  std::optional<double> recallBySize() const;
  void add(const PrimitiveTally& other);
};

/// Claims that two planes are orthogonal.
struct OrthogonalityTally {
  std::size_t claimed = 0;
  std::size_t checked = 0;  ///< both planes are true ones, so that the true angle is known
  std::size_t wrong = 0;    ///< of those checked, not orthogonal in truth

  /// wrong / checked; nothing if nothing was checked.
  std::optional<double> falseRate() const;
  void add(const OrthogonalityTally& other);
};

/// Result of comparePrimitives; sums over many scans with `add`.
struct PrimitiveTallies {
  std::size_t maps = 0;  ///< compared
  PrimitiveTally planes;
  PrimitiveTally lines;
  PrimitiveTally corners;
  OrthogonalityTally orthogonality;

  void add(const PrimitiveTallies& other);
};

}  // namespace opp::mapping
