// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/importing/import_plan.h"

#include "importing/dataset_formats.h"

#include <cmath>
#include <stdexcept>

namespace opp::mapping {
namespace {

void requirePositive(const std::optional<double>& value, const char* name) {
  if (value && !(*value > 0.0 && std::isfinite(*value))) {
    throw std::invalid_argument(std::string("import: the ") + name + " must be positive");
  }
}

}  // namespace

DatasetFormat datasetFormatFromName(std::string_view name) {
  if (name == "tum") return DatasetFormat::kTum;
  if (name == "icl-nuim") return DatasetFormat::kIclNuim;
  if (name == "7scenes") return DatasetFormat::kSevenScenes;
  if (name == "redwood") return DatasetFormat::kRedwood;
  if (name == "kitti") return DatasetFormat::kKitti;
  if (name == "pcd") return DatasetFormat::kPcd;
  if (name == "ply") return DatasetFormat::kPly;
  throw std::invalid_argument("'" + std::string(name) +
                              "' is none of tum, icl-nuim, 7scenes, redwood, kitti, pcd, ply");
}

ImportPlan planImport(DatasetFormat format, const std::filesystem::path& folder,
                      const ImportOptions& options) {
  requirePositive(options.range_unit, "unit of depth");
  requirePositive(options.rate, "rate");
  if (!std::isfinite(options.start_time)) {
    throw std::invalid_argument("import: the start time is not finite");
  }
  if (!std::filesystem::is_directory(folder)) {
    throw std::runtime_error(folder.string() + ": is no folder");
  }
  switch (format) {
    case DatasetFormat::kTum:
      return planTum(folder, options);
    case DatasetFormat::kIclNuim:
      return planIclNuim(folder, options);
    case DatasetFormat::kSevenScenes:
      return planSevenScenes(folder, options);
    case DatasetFormat::kRedwood:
      return planRedwood(folder, options);
    case DatasetFormat::kKitti:
      return planKitti(folder, options);
    case DatasetFormat::kPcd:
      return planCloudSeries(folder, ".pcd", options);
    case DatasetFormat::kPly:
      return planCloudSeries(folder, ".ply", options);
  }
  throw std::invalid_argument("import: unknown format");
}

}  // namespace opp::mapping
