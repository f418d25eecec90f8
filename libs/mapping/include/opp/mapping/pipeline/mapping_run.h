// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/run_report.h"
#include "opp/mapping/pipeline/mapper.h"

#include <cstddef>

namespace opp::mapping {

/// How far the mapping of one or more rawlogs has come, and what it has led to.
struct MappingRun {
  explicit MappingRun(const MapperParams& params) : mapper(params) {}

  Mapper mapper;
  RunReport report;               ///< its last session may have been read in part only
  std::size_t sessions_read = 0;  ///< whole sessions, all but maybe the last one of the report
  bool finished = false;          ///< see `finishMapping`
};

}  // namespace opp::mapping
