// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/evaluation/primitive_error.h"
#include "opp/mapping/evaluation/primitive_tally.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <iosfwd>

namespace opp::mapping {

/// Comparison of one pair of planar maps, or of two folders of them.
struct PrimitiveComparison {
  PrimitiveTallies tallies;
  std::size_t without_estimate =
      0;                          ///< true maps that have no estimated one: all in them is missed
  std::size_t without_truth = 0;  ///< estimated maps that have no true one: left out
};

/// Compares two files, or all pairs of files of two folders that have the same name up to endings
/// (000012.gt.json and 000012.json).
/// \throws std::runtime_error if a path is no planar map or folder, if one is a file and the other
/// a folder, or if no file of the folders is a pair.
PrimitiveComparison compareFiles(const std::filesystem::path& gt, const std::filesystem::path& est,
                                 const PrimitiveErrorParams& params,
                                 const Eigen::Isometry3d& gt_from_est);

/// For --json; units are part of the keys.
nlohmann::ordered_json toJson(const PrimitiveComparison& comparison);

/// Readable table.
void print(std::ostream& out, const PrimitiveComparison& comparison);

}  // namespace opp::mapping
