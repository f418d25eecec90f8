// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/evaluation/trajectory_error.h"

#include <nlohmann/json.hpp>

#include <iosfwd>

namespace opp::mapping {

/// All of TrajectoryError, for --json; units are part of the keys.
nlohmann::ordered_json toJson(const TrajectoryError& error);

/// Readable table of TrajectoryError.
void print(std::ostream& out, const TrajectoryError& error);

}  // namespace opp::mapping
