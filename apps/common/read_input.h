// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/core/scan.h"

#include <filesystem>

namespace opp::apps {

/// Whether a file is a rawlog, by its extension.
bool isRawlog(const std::filesystem::path& path);

/// A cloud file says nothing of a sensor's range: no point of it is too near or too far.
void openRange(SensorModel& sensor);

/// The cloud of a file, or the 3D observation `index` of a rawlog.
/// \throws std::runtime_error if it cannot be read or the rawlog has fewer observations.
mapping::Scan readInput(const std::filesystem::path& path, int index);

}  // namespace opp::apps
