// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace opp::mapping {

/// Colour of a surface, red, green and blue in [0, 255].
using Color = std::array<std::uint8_t, 3>;

/// The polygons of one plane as triangles.
struct PlaneMesh {
  std::string name;  ///< kind and id, e.g. "wall 3"
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  Color color{};
  std::vector<Eigen::Vector3f> vertices;  ///< the vertices of the polygons
  /// Indices into `vertices`, counter-clockwise seen from the normal's side.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Triangles of all planes that have polygons, in the order of the map. Floors and ceilings have a
/// colour of their own, other planes that of their family. Of a polygon that crosses itself (none
/// of ours does) the triangles fill what its outline encloses.
std::vector<PlaneMesh> triangulate(const PlanarMap& map);

}  // namespace opp::mapping
