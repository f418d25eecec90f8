// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/mapper_params.h"
#include "opp/mapping/io/rawlog_reader.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace opp::mapping {

/// All that a run's results depend on, as names and values for people: two runs of equal identity
/// give the same map.
using RunIdentity = std::map<std::string, std::string>;

/// Version of the program, rawlogs and initial poses (path as given, size, time of the last
/// change), selection and parameters, but for those of checkpoints.
/// \throws std::runtime_error if an input file does not exist.
RunIdentity identityOf(const std::vector<std::filesystem::path>& rawlogs,
                       const std::optional<std::filesystem::path>& initial_poses,
                       const RawlogOptions& selection, const MapperParams& params);

/// What differs, or the first of it by name: "--every is 2, was 1". Nothing if the two are equal.
std::optional<std::string> differenceOf(const RunIdentity& now, const RunIdentity& before);

}  // namespace opp::mapping
