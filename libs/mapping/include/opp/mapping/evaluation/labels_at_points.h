// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <vector>

namespace opp::mapping {

/// Points whose coordinates differ by less than this are the same [m]: files round float32
/// coordinates of rooms and halls by 1e-5 m at most, and scans do not hold two points this near.
inline constexpr double kSamePosition = 1e-4;

/// The label of each of `points` in another cloud of the same points, by index if both hold the
/// same positions in the same order (not finite ones included), else by position: the nearest point
/// within kSamePosition along each axis. −1 where there is none, and for points that are not
/// finite. O(n log n). \throws std::invalid_argument if `labels` and `labelled` differ in size.
std::vector<int> labelsAtPoints(const std::vector<Eigen::Vector3f>& points,
                                const std::vector<Eigen::Vector3f>& labelled,
                                const std::vector<int>& labels);

}  // namespace opp::mapping
