// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/loop/map_part.h"

#include <vector>

namespace opp::mapping {

/// Makes one of parts that are proven to show the same place; to be called once no more scans come.
///
/// Some tens of keyframes of each part, spread evenly, are compared with the keyframes of the
/// others that they resemble most; each pose that is found is a claim. Two parts are joined when
/// several keyframes make the same claim (ClaimPool), the keyframes of both do not stand in each
/// other's free space under it, and the body could have moved so in the time between. A place that
/// is recognized where one of these says that it cannot be has others like it, and proves nothing
/// (PartHistory::repeated). What more keyframes claim is joined first, and what it denies is
/// dropped: had parts been joined as the map grew, a look-alike seen early would have kept out the
/// truth that came later. What is not proven stays apart. The older of two parts keeps its frame,
/// id and place among `parts`. Same result for every `threads`. O(keyframes of all parts)
/// alignments.
void joinParts(std::vector<MapPart>& parts, const MapperParams& params, int threads = 1);

}  // namespace opp::mapping
