// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace opp::mapping {

/// Counts of one threshold; see regionMetrics.
struct RegionCounts {
  int threshold_percent = 0;
  int correct = 0;          ///< pairs of a true and an estimated region that are the same
  int over_segmented = 0;   ///< true regions that were split
  int under_segmented = 0;  ///< estimated regions that merge several true ones
  int missed = 0;           ///< true regions without any of these
  int noise = 0;            ///< estimated regions without any of these
};

/// Agreement of two segmentations of the same points.
struct RegionMetrics {
  int gt_regions = 0;
  int est_regions = 0;
  long points = 0;                   ///< whose true label is known
  std::vector<RegionCounts> counts;  ///< at each threshold of kRegionThresholds
  /// One number: share of the true regions that are correct, averaged over the thresholds 51, 52,
  /// ..., 95 %; in [0, 1].
  double mean_correct = 0.0;
};

/// Thresholds of the table [%].
inline constexpr int kRegionThresholds[] = {51, 55, 60, 65, 70, 75, 80, 85, 90, 95};
inline constexpr int kFirstRegionThreshold = 51;
inline constexpr int kLastRegionThreshold = 95;

/// Compares a segmentation with the true one after Hoover et al., "An experimental comparison of
/// range image segmentation algorithms", PAMI 1996. At a threshold T a region of |M| estimated and
/// one of |G| true points that share O points are
/// - correct, if O ≥ T|M| and O ≥ T|G|;
/// - a true region is over-segmented by ≥ 2 estimated ones, if each has O ≥ T|M| and together they
///   have ΣO ≥ T|G|;
/// - an estimated region under-segments ≥ 2 true ones, if each has O ≥ T|G| and together ΣO ≥ T|M|;
/// - missed or noise, if in none of these.
/// A region belongs to one of these at most. Where several apply, the one with the greatest mean of
/// its two shares (ΣO over the estimated and over the true points) is taken; ties go to correct,
/// then over-, then under-segmentation. This and the whole result do not depend on label values.
///
/// \param gt_labels the true label of each point: negative: on no region; from `first_region` on:
/// its region; between: unknown, the point does not count at all (SynPEB and SegComp reserve 0 to
/// 9). \param est_labels the estimated label of each point, in the same order; negative: none.
/// \return mean_correct is zero and all estimated regions are noise if there is no true region. O(n
/// log n). \throws std::invalid_argument if the sizes differ or first_region is negative.
RegionMetrics regionMetrics(const std::vector<int>& gt_labels, const std::vector<int>& est_labels,
                            int first_region = 0);

}  // namespace opp::mapping
