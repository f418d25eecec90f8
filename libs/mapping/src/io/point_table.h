// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// What the readers of the single formats make of a file: columns of numbers by name.
struct PointTable {
  std::size_t size = 0;  ///< length of each column
  /// x y z, nx ny nz, label and intensity, as far as the file has them.
  std::map<std::string, std::vector<double>> columns;
  int rows = 0;  ///< of a grid; 0: none
  int cols = 0;
  Eigen::Vector3f viewpoint = Eigen::Vector3f::Zero();
};

/// The name under which a file's field goes into the table; empty: it is passed over.
std::string columnName(std::string_view field);

/// Each reader takes the whole file. \throws std::runtime_error that names the place in it.
PointTable readPly(std::string_view file);
PointTable readPcd(std::string_view file);
PointTable readXyz(std::string_view file);

}  // namespace opp::mapping
