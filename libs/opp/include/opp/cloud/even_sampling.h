// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sampling_params.h"
#include "opp/geometry/point_cloud.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace opp {

/// Edge length of the cubic cells [m] of which about `target` are occupied by `points` (all
/// finite), at least `minimum`. Points lie on surfaces, so the count goes with 1/length². Where the
/// points are too few or too many of them are equal, as many cells as nine tenths of the points
/// are aimed at. 0 points: `minimum`. O(points).
double spacingForCount(const std::vector<Eigen::Vector3f>& points, std::size_t target,
                       double minimum);

/// Thins `dense` (its `spacing` is not used) to samples at least about `spacing` apart: each entry
/// joins the nearest earlier sample within `spacing` along the same surface (normals within
/// `merge_angle`, offset explained by noise), else becomes a sample. A sample is the weighted mean
/// of its entries, so parallel or crossing surfaces closer than `spacing` stay apart. O(entries).
/// \param sample_of_entry unless null, becomes the sample that each entry joined.
/// \throws std::invalid_argument if `spacing` is not positive and finite.
OrientedCloud sampleEvenly(const OrientedCloud& dense, double spacing, const SamplingParams& params,
                           std::vector<int>* sample_of_entry = nullptr);

}  // namespace opp
