// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace opp::test {

/// `count` points in a cube of 2 m with random normals: clutter without any plane.
OrientedCloud randomCloud(std::uint64_t seed, int count);

/// Inputs that break careless code: 0 to 3 points, all equal, collinear, one perfect plane, two
/// parallel planes, coordinates of 10⁶ m, clutter. Names say what.
std::vector<std::pair<std::string, OrientedCloud>> degenerateClouds();

}  // namespace opp::test
