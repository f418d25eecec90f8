// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/cloud/sensor_model.h"
#include "opp/mapping/dense/occupancy_map.h"
#include "opp/mapping/io/rawlog_reader.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>

namespace opp::mapping {

/// Adds a rawlog's scans at their final poses to an OctoMap by reading the rawlog once more, so
/// that no raw points need to be kept while mapping. Scans without a pose are left out. \param
/// map_from_body poses by Scan::index. \param range_limits returns outside are no surfaces and are
/// left out. \param threads ≤ 0: all cores; no influence on the result. \param progress see
/// ProgressCallback.
void insertRawlog(const std::filesystem::path& rawlog, const RawlogOptions& selection,
                  const std::map<std::size_t, Eigen::Isometry3d>& map_from_body,
                  const SensorModel& range_limits, int threads,
                  const std::function<void(double, std::size_t)>& progress, OccupancyMap& map);

}  // namespace opp::mapping
