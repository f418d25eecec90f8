// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/solids.h"

#include "opp/geometry/constants.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace opp::mapping {
namespace {

using Ring = std::vector<Eigen::Vector3d>;

void requirePositive(double value, const char* what) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string(what) + " must be greater than 0");
  }
}

Ring placed(const Eigen::Isometry3d& map_from_body, Ring ring) {
  for (auto& vertex : ring) vertex = map_from_body * vertex;
  return ring;
}

/// Frame of a wall: x along it, z up, origin at the start of its foot.
Eigen::Isometry3d mapFromWall(const Wall& wall) {
  const Eigen::Vector2d along = (wall.end - wall.start).normalized();
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear().col(0) << along.x(), along.y(), 0.0;
  result.linear().col(1) << -along.y(), along.x(), 0.0;
  result.translation() << wall.start.x(), wall.start.y(), 0.0;
  return result;
}

void requireOpeningsInside(const Wall& wall) {
  const double length = (wall.end - wall.start).norm();
  double free_from = 0.0;
  for (const Opening& opening : wall.openings) {
    requirePositive(opening.width, "width of an opening");
    requirePositive(opening.height, "height of an opening");
    if (!(opening.offset > free_from && opening.offset + opening.width < length &&
          opening.bottom >= 0.0 && opening.bottom + opening.height < wall.height)) {
      throw std::invalid_argument("opening at offset " + std::to_string(opening.offset) +
                                  " leaves its wall, or openings touch or are out of order");
    }
    free_from = opening.offset + opening.width;
  }
}

/// One broad side of a wall at y; doors are notches of the outer ring, windows are holes.
void addBroadSide(World& world, const Eigen::Isometry3d& map_from_wall, const Wall& wall,
                  double y) {
  const double length = (wall.end - wall.start).norm();
  Ring outer = {{0.0, y, 0.0}};
  std::vector<Ring> holes;
  for (const Opening& o : wall.openings) {
    const double left = o.offset, right = o.offset + o.width, top = o.bottom + o.height;
    if (o.bottom > 0.0) {
      holes.push_back({{left, y, o.bottom}, {left, y, top}, {right, y, top}, {right, y, o.bottom}});
    } else {
      for (const auto& [x, z] : {std::pair{left, 0.0}, {left, top}, {right, top}, {right, 0.0}}) {
        outer.emplace_back(x, y, z);
      }
    }
  }
  outer.emplace_back(length, y, 0.0);
  outer.emplace_back(length, y, wall.height);
  outer.emplace_back(0.0, y, wall.height);
  if (y > 0.0) outer = Ring(outer.rbegin(), outer.rend());  // seen from +y, x runs to the left
  for (Ring& hole : holes) hole = placed(map_from_wall, hole);
  world.addFace(placed(map_from_wall, outer), holes);
}

/// Jambs, lintel, sill and pane of one opening.
void addReveal(World& world, const Eigen::Isometry3d& map_from_wall, const Opening& o, double y) {
  const double left = o.offset, right = o.offset + o.width;
  const double bottom = o.bottom, top = o.bottom + o.height;
  const auto add = [&](const Ring& ring) { world.addFace(placed(map_from_wall, ring)); };
  add({{left, -y, bottom}, {left, y, bottom}, {left, y, top}, {left, -y, top}});
  add({{right, -y, bottom}, {right, -y, top}, {right, y, top}, {right, y, bottom}});
  add({{left, -y, top}, {left, y, top}, {right, y, top}, {right, -y, top}});
  if (bottom > 0.0) {
    add({{left, -y, bottom}, {right, -y, bottom}, {right, y, bottom}, {left, y, bottom}});
  }
  if (o.closed) {
    add({{left, 0.0, bottom}, {right, 0.0, bottom}, {right, 0.0, top}, {left, 0.0, top}});
  }
}

}  // namespace

void addBox(World& world, const Eigen::Isometry3d& map_from_box, const Eigen::Vector3d& size) {
  for (int axis = 0; axis < 3; ++axis) requirePositive(size[axis], "size of a box");
  const double x = 0.5 * size.x(), y = 0.5 * size.y(), z = size.z();
  const auto add = [&](const Ring& ring) { world.addFace(placed(map_from_box, ring)); };
  add({{x, -y, 0.0}, {x, y, 0.0}, {x, y, z}, {x, -y, z}});
  add({{-x, -y, 0.0}, {-x, -y, z}, {-x, y, z}, {-x, y, 0.0}});
  add({{-x, y, 0.0}, {-x, y, z}, {x, y, z}, {x, y, 0.0}});
  add({{-x, -y, 0.0}, {x, -y, 0.0}, {x, -y, z}, {-x, -y, z}});
  add({{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}});
  add({{-x, -y, 0.0}, {-x, y, 0.0}, {x, y, 0.0}, {x, -y, 0.0}});
}

void addRoom(World& world, const std::vector<Eigen::Vector2d>& corners, double bottom,
             double height, bool walls) {
  requirePositive(height, "height of a room");
  if (corners.size() < 3) throw std::invalid_argument("room: needs at least 3 corners");
  Ring floor, ceiling;
  for (const auto& corner : corners) {
    floor.emplace_back(corner.x(), corner.y(), bottom);
    ceiling.emplace_back(corner.x(), corner.y(), bottom + height);
  }
  world.addFace(floor);
  if (world.faces().back().plane.normal().z() < 0.0) {
    throw std::invalid_argument("room: its corners must run counter-clockwise seen from above");
  }
  world.addFace(Ring(ceiling.rbegin(), ceiling.rend()));
  for (std::size_t i = 0; walls && i < corners.size(); ++i) {
    const std::size_t j = (i + 1) % corners.size();
    world.addFace({floor[i], ceiling[i], ceiling[j], floor[j]});
  }
}

void addCylinder(World& world, const Eigen::Isometry3d& map_from_cylinder, double radius,
                 double height, int facets) {
  requirePositive(radius, "radius of a cylinder");
  requirePositive(height, "height of a cylinder");
  if (facets < 3) throw std::invalid_argument("cylinder: needs at least 3 facets");
  Ring lower, upper;
  for (int k = 0; k < facets; ++k) {
    const double angle = 2.0 * kPi * k / facets;
    lower.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    upper.emplace_back(lower.back().x(), lower.back().y(), height);
  }
  lower = placed(map_from_cylinder, lower);
  upper = placed(map_from_cylinder, upper);
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const std::size_t j = (i + 1) % lower.size();
    world.addFace({lower[i], lower[j], upper[j], upper[i]}, {}, true);
  }
  world.addFace(upper);
  world.addFace(Ring(lower.rbegin(), lower.rend()));
}

void addWall(World& world, const Wall& wall) {
  const double length = (wall.end - wall.start).norm();
  requirePositive(length, "length of a wall");
  requirePositive(wall.thickness, "thickness of a wall");
  requirePositive(wall.height, "height of a wall");
  requireOpeningsInside(wall);
  const Eigen::Isometry3d map_from_wall = mapFromWall(wall);
  const double y = 0.5 * wall.thickness, z = wall.height;
  addBroadSide(world, map_from_wall, wall, -y);
  addBroadSide(world, map_from_wall, wall, y);
  for (const Opening& opening : wall.openings) addReveal(world, map_from_wall, opening, y);
  const auto add = [&](const Ring& ring) { world.addFace(placed(map_from_wall, ring)); };
  add({{0.0, -y, z}, {length, -y, z}, {length, y, z}, {0.0, y, z}});
  add({{length, -y, 0.0}, {length, y, 0.0}, {length, y, z}, {length, -y, z}});
  add({{0.0, -y, 0.0}, {0.0, -y, z}, {0.0, y, z}, {0.0, y, 0.0}});
}

}  // namespace opp::mapping
