// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"

namespace opp::mapping {

/// Appends all of `other` to `map`, moved by `map_from_other`: keyframes, landmarks, factors, links
/// and scans keep their order and get the next free ids. Nothing ties the two together yet: that is
/// for the factors of the places they share. O(size of other).
void appendMap(const Eigen::Isometry3d& map_from_other, MapState&& other, MapState& map);

}  // namespace opp::mapping
