// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/loop/claim_pool.h"
#include "opp/mapping/loop/motion_between.h"

#include <vector>

namespace opp::mapping {

/// Whether two maps fit at another pose, too, than the one that some keyframes claim: one of them
/// looks the same after a motion (a symmetric hall turned around, the next of a row of rooms), and
/// neither what was seen nor motion denies what follows for the other. A claim by itself cannot
/// tell: of a hall that is looked at from opposite places, the wrong pose makes all agree, the
/// right one only what the beams of a lidar do not miss from the other side.
/// \param claims of one pose of b in a, not empty
/// O(claims) alignments of a scan with itself.
bool fitsAnotherWay(const MapState& a, const MapState& b, const std::vector<PlaceClaim>& claims,
                    const MotionBetween& motion, const MapperParams& params);

}  // namespace opp::mapping
