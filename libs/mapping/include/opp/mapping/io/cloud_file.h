// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/point_cloud.h"

#include <filesystem>
#include <vector>

namespace opp::mapping {

/// A cloud and a number for each of its points.
struct LabeledCloud {
  PointCloud cloud;
  std::vector<int> labels;  ///< as long as the cloud
};

/// Reads the points, and the normals if there are any, of a file in metres. Its kind follows from
/// the extension:
/// - .ply: text or binary of either byte order, numbers of any type, further properties and
///   elements passed over; points x y z, normals nx ny nz (or normal_x ...);
/// - .pcd: ascii, binary and binary_compressed; points x y z, normals normal_x ... (or nx ...);
/// grid
///   (height > 1) and viewpoint kept;
/// - .xyz, .txt: lines of x y z or, if three more numbers are a unit vector in every line, x y z
///   nx ny nz; further numbers are passed over; separated by blanks, commas or semicolons; # starts
///   a comment.
/// Points that are not finite stay in their place (no measurement). A file of no points gives an
/// empty cloud.
/// \throws std::runtime_error if the file cannot be read, is of another kind, damaged or truncated;
/// the message names the file and the place in it.
PointCloud readCloudFile(const std::filesystem::path& path);

/// Reads a .ply or .pcd file with a label per point: its field `label`, else `intensity` (where
/// SynPEB keeps it), rounded; −1 where that is not finite.
/// \throws std::runtime_error as readCloudFile, and if there is no such field.
LabeledCloud readLabeledCloudFile(const std::filesystem::path& path);

/// Writes the points (float x y z) and labels (int label) as a binary, little-endian PLY file:
/// whole or not at all. \throws std::invalid_argument if there is not one label per point;
/// std::runtime_error if the file cannot be written.
void writeLabeledPly(const std::filesystem::path& path, const PointCloud& cloud,
                     const std::vector<int>& labels);

}  // namespace opp::mapping
