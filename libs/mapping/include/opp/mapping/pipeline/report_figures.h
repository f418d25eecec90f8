// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/map_state.h"
#include "opp/mapping/core/run_report.h"
#include "opp/mapping/pipeline/mapper.h"
#include "opp/mapping/planar/planar_params.h"
#include "opp/mapping/report/html_report.h"

#include <vector>

namespace opp::mapping {

/// Where the body was in `map` at each scan that was read of a session. Scans whose stamp is no
/// finite number are left out.
SessionTrack trackOf(const MapState& map, const SessionReport& session, int session_id);

/// What the report needs of a finished mapper. \param planar_maps one for each of its parts, in
/// their order.
ReportFigures reportFigures(const Mapper& mapper, const RunReport& report,
                            const std::vector<PlanarMap>& planar_maps, const PlanarParams& params);

}  // namespace opp::mapping
