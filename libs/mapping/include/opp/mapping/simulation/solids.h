// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/simulation/world.h"

#include <Eigen/Geometry>

#include <vector>

namespace opp::mapping {

/// Opening of a wall: a door where `bottom` is 0, else a window. `closed`: a pane or leaf in the
/// middle of the wall's thickness closes it.
struct Opening {
  double offset = 0.0;  ///< from the wall's start to the opening's near side [m]
  double width = 0.9;
  double bottom = 0.0;
  double height = 2.0;
  bool closed = false;
};

/// Upright wall with a thickness; x runs along it from `start`, openings are ordered by offset and
/// do not touch each other or the wall's ends.
struct Wall {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< of the centre line, in the map [m]
  Eigen::Vector2d end = Eigen::Vector2d::Zero();
  double thickness = 0.1;
  double height = 2.5;
  std::vector<Opening> openings;
};

/// Box with its base centre at the origin of its frame and all six faces outward.
/// \param size along x, y, z [m], each > 0.
/// All functions here \throws std::invalid_argument if a size is not positive.
void addBox(World& world, const Eigen::Isometry3d& map_from_box, const Eigen::Vector3d& size);

/// Inside of an upright prism: floor, ceiling and, if `walls`, walls, all seen from inside.
/// \param corners of the floor, counter-clockwise seen from above [m].
void addRoom(World& world, const std::vector<Eigen::Vector2d>& corners, double bottom,
             double height, bool walls = true);

/// Upright cylinder as a prism of `facets` curved faces (no planes of the truth) with flat ends.
void addCylinder(World& world, const Eigen::Isometry3d& map_from_cylinder, double radius,
                 double height, int facets = 48);

/// \throws std::invalid_argument also if an opening leaves the wall or they are out of order.
void addWall(World& world, const Wall& wall);

}  // namespace opp::mapping
