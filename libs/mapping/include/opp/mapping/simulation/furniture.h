// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/simulation/world.h"

#include <Eigen/Geometry>

#include <string_view>

namespace opp::mapping {

/// Adds a piece of furniture made of boxes. Its foot's centre is the origin of its frame, its front
/// looks along +x; `size` is (depth, width, height) [m] along x, y, z.
/// \param kind "table" (top on four legs), "chair", "cabinet" (body on a plinth, two doors that
/// stand out), "shelf" (open front, back, sides, boards), "bed" (base, mattress, pillow, head),
/// "sofa" (seat, back, two arms).
/// \throws std::invalid_argument if the kind is unknown or the size is too small for its parts.
void addFurniture(World& world, std::string_view kind, const Eigen::Isometry3d& map_from_furniture,
                  const Eigen::Vector3d& size);

/// Whether `kind` is one of addFurniture's.
bool isFurniture(std::string_view kind);

}  // namespace opp::mapping
