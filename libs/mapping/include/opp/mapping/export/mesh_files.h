// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/export/plane_mesh.h"

#include <filesystem>
#include <vector>

namespace opp::mapping {

/// Text PLY: vertices with normal and colour, triangles. Each file is written whole or not at all;
/// the same meshes give the same bytes. \throws std::runtime_error if the file cannot be written.
void writePly(const std::filesystem::path& path, const std::vector<PlaneMesh>& meshes);

/// OBJ with one object a plane; colours as three further numbers of each vertex, which most readers
/// understand, so that no second file is needed. Errors as writePly.
void writeObj(const std::filesystem::path& path, const std::vector<PlaneMesh>& meshes);

/// Binary glTF 2.0 with one node a plane, seen from both sides, turned from z up to glTF's y up.
/// Errors as writePly.
void writeGlb(const std::filesystem::path& path, const std::vector<PlaneMesh>& meshes);

}  // namespace opp::mapping
