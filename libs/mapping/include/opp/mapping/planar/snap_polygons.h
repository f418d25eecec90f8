// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/planar/planar_params.h"

namespace opp::mapping {

/// Moves vertices of each plane's polygons that are within `snap` of one of its corners onto that
/// corner, and others within `snap` of one of its lines onto that line, so that polygons of planes
/// that meet share their edge: samples end short of it or, by noise, behind it. Polygons that the
/// move ties up are untied; what is smaller than `min_area` afterwards goes. Sets area and centroid
/// of the planes that it changes. Cost: O(vertices · lines of the plane).
void snapPolygons(PlanarMap& map, const PlanarParams& params);

}  // namespace opp::mapping
