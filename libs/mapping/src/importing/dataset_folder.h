// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/importing/import_plan.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace opp::mapping {

/// Pose of the body (x forward, y left, z up) in the optical frame (x right, y down, z forward).
Eigen::Isometry3d opticalFromBody();

enum class NumberIn { kFirst, kLast };

/// Files of a folder whose name ends in `suffix`, by the first or last number in the rest of it.
/// \throws std::runtime_error if the folder is none, holds no such file, or two have one number.
std::map<long, std::filesystem::path> numberedFiles(const std::filesystem::path& folder,
                                                    const std::string& suffix,
                                                    NumberIn which = NumberIn::kFirst);

/// Adds the numbered files as frames at start_time + number / rate. \throws std::runtime_error that
/// names a missing number, unless options.skip_missing.
void addNumberedFrames(const std::map<long, std::filesystem::path>& files, double default_rate,
                       const ImportOptions& options, ImportPlan& plan);

/// The folder itself or its subfolder `name` if there is one.
std::filesystem::path subfolderIfAny(const std::filesystem::path& folder, const std::string& name);

/// The only file of a folder whose name ends in one of the suffixes; empty if there is none.
/// \throws std::runtime_error if there are several: `what` says of which to choose with --poses.
std::filesystem::path onlyFile(const std::filesystem::path& folder,
                               const std::vector<std::string>& suffixes, const std::string& what);

/// All numbers of a text file, line by line; lines without numbers are left out.
/// \throws std::runtime_error that names file and line for what is no number.
std::vector<std::vector<double>> readNumbers(const std::filesystem::path& file);

/// Rigid motion from the first three rows of a 4 × 4 matrix, with its rotation made orthonormal;
/// nothing if a number is not finite (sets write that for lost poses).
/// \throws std::runtime_error that names `where` if it is no rotation within 1 %.
std::optional<Eigen::Isometry3d> poseFromRows(const std::vector<double>& rows,
                                              const std::string& where);

}  // namespace opp::mapping
