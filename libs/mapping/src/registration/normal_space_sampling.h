// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"

#include <cstdint>
#include <vector>

namespace opp::mapping {

/// At most `max_count` indices of samples, as even over the directions of their normals as the
/// cloud allows (normal-space sampling, Rusinkiewicz & Levoy 2001), ascending. Few samples that
/// face an odd way then weigh as much as many on the floor. Linear time.
std::vector<std::uint32_t> sampleNormalSpace(const OrientedCloud& cloud, std::size_t max_count);

}  // namespace opp::mapping
