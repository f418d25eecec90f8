// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/importing/import_plan.h"

#include <cstddef>
#include <filesystem>
#include <functional>

namespace opp::mapping {

/// Writes the frames of a plan to a rawlog, one after the other; memory does not grow with their
/// number. Depth images keep the counts of their files bit by bit, except that 65535, which the
/// sets use for "none", becomes 0, which rawlogs use. Rows are turned over where fy is negative.
/// The body frame is that of the sensor (x forward). Labels are DEPTH and LIDAR. \param progress
/// called with the number of frames done. \throws std::runtime_error that names the file if one
/// cannot be read or written. Nothing is left of an unfinished rawlog.
void runImport(const ImportPlan& plan, const std::filesystem::path& rawlog,
               const std::function<void(std::size_t)>& progress);

}  // namespace opp::mapping
