// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/evaluation/region_metrics.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <iosfwd>
#include <optional>

namespace opp::mapping {

/// Compares the labels of two clouds of the same points.
/// \param first_region smallest true label that is a region; without it, 10 for .pcd files (SynPEB
/// reserves 0 to 9 for what is unknown) and 0 for others.
/// \throws std::runtime_error if a file is no labelled cloud, if there is no true region, or if the
/// clouds have no labelled point in common.
RegionMetrics compareLabels(const std::filesystem::path& gt, const std::filesystem::path& est,
                            std::optional<int> first_region);

/// For --json.
nlohmann::ordered_json toJson(const RegionMetrics& metrics);

/// Readable table.
void print(std::ostream& out, const RegionMetrics& metrics);

}  // namespace opp::mapping
