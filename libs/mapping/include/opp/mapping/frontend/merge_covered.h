// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"

namespace opp::mapping {

/// Joins plane landmarks that lie where a larger one was seen: both face the same way, and most of
/// the smaller one's support is nearer to the larger one than its samples can tell, at places where
/// that was seen, too. No two surfaces can be seen at one place; what is said to be a second one is
/// the first, seen badly, from far or in part. The larger one's plane stays. For the finished map,
/// whose views were adopted (`adoptViews`). Returns how many were joined.
/// \param cell edge of the raster cells [m]
/// O(samples of all keyframes + Σ cells of pairs that face alike).
int mergeCovered(MapState& map, double cell);

}  // namespace opp::mapping
