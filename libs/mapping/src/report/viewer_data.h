// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/report/html_report.h"

#include <string>

namespace opp::mapping {

/// What viewer.js draws beside the mesh, as JSON of numbers only: `level_from_map` (quaternion x,
/// y, z, w), `lines` (their ends, two by two), `corners`, `way` (a list of points for each stretch
/// without a gap). In the frame of the map, to millimetres.
std::string viewerData(const ReportFigures& figures);

}  // namespace opp::mapping
