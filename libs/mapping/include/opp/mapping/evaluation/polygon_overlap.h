// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/geometry/plane.h"
#include "opp/mapping/core/planar_map.h"

#include <vector>

namespace opp::mapping {

/// Area of polygons that lie on one plane and do not overlap each other, holes not counted [m²].
double areaOf(const std::vector<PlanarPolygon>& polygons);

/// Area that polygons on `plane` share with others, which are projected onto it [m²]. Measured on
/// about `kOverlapSamples` evenly spaced points of the first polygons, which any rings survive
/// (self-intersections included) and which is exact to some percent of the area: enough to tell
/// whether two surfaces are the same, not to compare areas. O(samples · vertices).
double sharedArea(const Plane& plane, const std::vector<PlanarPolygon>& on_plane,
                  const std::vector<PlanarPolygon>& others);

/// Distance within the plane of a point's projection from the nearest polygon [m]: 0 inside of one
/// and in holes, infinite if there is none. O(vertices).
double distanceTo(const Plane& plane, const std::vector<PlanarPolygon>& on_plane,
                  const Eigen::Vector3d& point);

inline constexpr int kOverlapSamples = 2000;

}  // namespace opp::mapping
