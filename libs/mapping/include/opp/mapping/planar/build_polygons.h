// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/planar/planar_params.h"
#include "opp/mapping/planar/plane_extent.h"

#include <vector>

namespace opp::mapping {

/// Polygons around a plane's support, biggest first; none where there is too little of it. Gaps up
/// to `bridge` are closed; holes stay where rays passed through them (doors, windows) and are
/// closed where the plane was merely not seen. Outlines are simplified by at most
/// `outline_tolerance`. Vertices lie on the plane to rounding; ring directions as PlanarPolygon
/// demands; polygons are simple and do not overlap. Cost: about linear in the number of cells.
std::vector<PlanarPolygon> buildPolygons(const PlaneExtent& extent, const PlanarParams& params);

/// Area of polygons on one plane, holes not counted [m²].
double areaOf(const std::vector<PlanarPolygon>& polygons, const Eigen::Vector3d& normal);

/// Centre of the area of polygons on one plane; zero if there is none.
Eigen::Vector3d centroidOf(const std::vector<PlanarPolygon>& polygons,
                           const Eigen::Vector3d& normal);

}  // namespace opp::mapping
