// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/core/run_report.h"

#include <iosfwd>

namespace opp::mapping {

/// Writes run.json: version, report, effective parameters, peak memory of this process.
void writeRunJson(std::ostream& os, const RunReport& report, const MapperParams& params);

}  // namespace opp::mapping
