// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/importing/import_plan.h"

#include <filesystem>
#include <string>

// One function for each form of data set: see planImport.

namespace opp::mapping {

ImportPlan planTum(const std::filesystem::path& folder, const ImportOptions& options);
ImportPlan planIclNuim(const std::filesystem::path& folder, const ImportOptions& options);
ImportPlan planSevenScenes(const std::filesystem::path& folder, const ImportOptions& options);
ImportPlan planRedwood(const std::filesystem::path& folder, const ImportOptions& options);
ImportPlan planKitti(const std::filesystem::path& folder, const ImportOptions& options);
/// \param extension ".pcd" or ".ply".
ImportPlan planCloudSeries(const std::filesystem::path& folder, const std::string& extension,
                           const ImportOptions& options);

}  // namespace opp::mapping
