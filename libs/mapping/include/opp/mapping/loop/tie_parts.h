// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/loop/map_part.h"

#include <vector>

namespace opp::mapping {

/// Makes one map again of parts that came of one by a split, as what tied them
/// (PartHistory::beginnings) has it: to be called once they have joined others. What those saw may
/// tie them better than before (`closeLooseTies`); else they are to be split again. The earlier of
/// two parts keeps its frame and its place among `parts`. True if there were any such parts.
/// O(parts² · ties · scans).
bool tieParts(std::vector<MapPart>& parts);

}  // namespace opp::mapping
