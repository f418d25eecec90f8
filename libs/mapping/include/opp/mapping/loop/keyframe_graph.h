// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/se3.h"

#include <vector>

namespace opp::mapping {

/// Drift of what a keyframe sees goes with turns at this distance [m].
double leverOf(const Keyframe& keyframe);

/// Variance [m²] of what a keyframe sees, in the worst direction, from the covariance of (ω, v) of
/// its pose.
double viewVariance(const Matrix6d& covariance, const Keyframe& keyframe);

/// Variance [m²] of each keyframe's position relative to keyframe `from`: the least sum of link
/// variances over all paths (Dijkstra); infinite where no link leads. An upper bound, since
/// parallel paths are not combined. O((links + keyframes) log keyframes).
std::vector<double> relativeVariances(const MapState& map, int from);

/// The at most `count` keyframes whose views are nearest to that of keyframe `near`, itself
/// included, among those with variance[k] <= max_variance, ascending. O(keyframes log keyframes).
std::vector<int> nearestViews(const MapState& map, int near, const std::vector<double>& variances,
                              double max_variance, int count);

}  // namespace opp::mapping
