// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <vector>

namespace opp {

/// Directions that many of the unit vectors `normals` share, whatever their signs; most first, then
/// those that are orthogonal to two of these. Each is the mean of the normals around it, of which
/// there are at least 32, and one in 40. Unit length, at least 15° apart, at most eight and their
/// third axes; empty if no normals agree. O(normals).
std::vector<Eigen::Vector3d> mainDirections(const std::vector<Eigen::Vector3d>& normals);

}  // namespace opp
