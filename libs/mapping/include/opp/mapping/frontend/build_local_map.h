// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/registration/local_map.h"

#include <vector>

namespace opp::mapping {

/// Surfels of some keyframes of a map at their present poses, and the planes of all its landmarks.
/// O(samples of the keyframes).
LocalMap localMapOf(const MapState& map, const std::vector<int>& keyframes,
                    const MapperParams& params);

}  // namespace opp::mapping
