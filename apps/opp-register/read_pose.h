// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <filesystem>

namespace opp::apps {

/// A pose from a text file: 16 numbers, the rows of a 4×4 matrix, separated by blanks; # starts a
/// comment. The rotation is made orthonormal to the last digit.
/// \throws std::runtime_error that names the file and the place if it cannot be read, is not 16
/// numbers, or its matrix is not a rigid motion within 1e-3.
Eigen::Isometry3d readPose(const std::filesystem::path& path);

}  // namespace opp::apps
