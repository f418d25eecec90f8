// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"

#include <optional>
#include <vector>

namespace opp::mapping {

/// Some keyframes of a map, which must outlive this.
using KeyframeViews = std::vector<const Keyframe*>;

/// All keyframes of a map.
KeyframeViews viewsOf(const MapState& map);

/// How much keyframes of two maps (or of two parts of one) contradict each other if `a_from_b` is
/// right: of the samples of keyframes with a common view, conflicts with free space over agreements
/// and conflicts; nothing if there is no common view. Some of b, spread evenly, are looked at.
std::optional<double> conflictOf(const KeyframeViews& a, const KeyframeViews& b,
                                 const Eigen::Isometry3d& a_from_b, const MapperParams& params);

}  // namespace opp::mapping
