// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/planar/planar_params.h"

#include <Eigen/Core>

#include <optional>

namespace opp::mapping {

/// Direction that points up, from the planes themselves: of all plane families (a plane without one
/// counts alone) the one of most area whose direction is within `max_camera_tilt` of `roughly_up`.
/// Nothing if there is none. A first guess for cameras that carry no gravity sensor: the z axis of
/// the first body frame is then only roughly up.
std::optional<Eigen::Vector3d> estimateUp(const PlanarMap& map, const Eigen::Vector3d& roughly_up,
                                          const PlanarParams& params);

/// Sets the kind of each plane. `up`: unit vector. Level planes that face up are "floor" if nothing
/// of the map's level planes that face up lies lower by more than a step of `outline_tolerance`,
/// level planes that face down are "ceiling" if none lies higher; others are "horizontal". Plumb
/// planes are "wall" if they span `wall_height`, else "vertical". All the rest is "other".
void classifyPlanes(PlanarMap& map, const Eigen::Vector3d& up, const PlanarParams& params);

}  // namespace opp::mapping
