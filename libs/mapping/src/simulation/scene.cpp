// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/simulation/scene.h"

#include "opp/mapping/simulation/furniture.h"
#include "opp/mapping/simulation/solids.h"

#include "built_in_scenes.h"
#include "scene_text.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace opp::mapping {
namespace {

/// Position (2 or 3 numbers; z = 0 if left out as `at`) and yaw of an element's frame.
Eigen::Isometry3d placement(const SceneSection& section) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = section.vector3("at");
  result.linear() = (Eigen::AngleAxisd(section.angle("yaw", 0.0), Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(section.angle("pitch", 0.0), Eigen::Vector3d::UnitY()))
                        .toRotationMatrix();
  return result;
}

void addFaceOf(const SceneSection& section, World& world) {
  std::vector<Eigen::Vector3d> ring;
  for (const auto& v : section.list("vertex", 3)) ring.emplace_back(v[0], v[1], v[2]);
  world.addFace(ring);
}

void addRoomOf(const SceneSection& section, World& world) {
  std::vector<Eigen::Vector2d> corners;
  for (const auto& v : section.list("corner", 2)) corners.emplace_back(v[0], v[1]);
  const std::string walls = section.text("walls", "all");
  if (walls != "all" && walls != "none") section.fail("'walls' must be all or none");
  addRoom(world, corners, section.number("bottom", 0.0), section.number("height"), walls == "all");
}

void addWallOf(const SceneSection& section, World& world) {
  Wall wall;
  wall.start = section.vector2("from");
  wall.end = section.vector2("to");
  wall.thickness = section.number("thickness", wall.thickness);
  wall.height = section.number("height");
  for (const auto& v : section.list("door", 3)) {
    wall.openings.push_back({v[0], v[1], 0.0, v[2], false});
  }
  for (const auto& v : section.list("closed_door", 3)) {
    wall.openings.push_back({v[0], v[1], 0.0, v[2], true});
  }
  for (const auto& v : section.list("window", 4)) {
    wall.openings.push_back({v[0], v[1], v[2], v[3], true});
  }
  std::sort(wall.openings.begin(), wall.openings.end(),
            [](const Opening& a, const Opening& b) { return a.offset < b.offset; });
  addWall(world, wall);
}

void readScene(const SceneSection& section, Scene& scene) {
  scene.description = section.text("description", "");
  const double frames = section.number("frames", scene.frames);
  if (!(frames >= 1.0 && frames <= 1e6)) section.fail("'frames' must be from 1 to 1000000");
  scene.frames = static_cast<int>(frames);
}

void readPath(const SceneSection& section, Scene& scene) {
  scene.motion.speed = section.number("speed", scene.motion.speed);
  scene.motion.turn_rate = section.angle("turn_rate", scene.motion.turn_rate);
  scene.motion.jitter_position = section.number("jitter_position", scene.motion.jitter_position);
  scene.motion.jitter_angle = section.angle("jitter_angle", scene.motion.jitter_angle);
  validate(scene.motion);
  for (const auto& v : section.list("waypoint", 3, 2)) {
    scene.waypoints.push_back({{v[0], v[1], v[2]}, v[3], v[4]});
  }
}

void readSection(const SceneSection& section, Scene& scene) {
  const std::string& kind = section.kind();
  if (kind == "scene") {
    readScene(section, scene);
  } else if (kind == "path") {
    readPath(section, scene);
  } else if (kind == "face") {
    addFaceOf(section, scene.world);
  } else if (kind == "room") {
    addRoomOf(section, scene.world);
  } else if (kind == "wall") {
    addWallOf(section, scene.world);
  } else if (kind == "box") {
    addBox(scene.world, placement(section), section.vector3("size"));
  } else if (kind == "cylinder") {
    addCylinder(scene.world, placement(section), section.number("radius"),
                section.number("height"));
  } else if (isFurniture(kind)) {
    addFurniture(scene.world, kind, placement(section), section.vector3("size"));
  } else {
    section.fail(
        "unknown kind of section; known: scene, path, face, room, wall, box, cylinder, "
        "table, chair, cabinet, shelf, bed, sofa");
  }
}

}  // namespace

Scene parseScene(std::istream& text, const std::string& source) {
  Scene scene;
  scene.name = source;
  for (const SceneSection& section : sceneSections(text, source)) {
    try {
      readSection(section, scene);
    } catch (const std::invalid_argument& error) {
      if (std::string(error.what()).rfind(source + ":", 0) == 0) throw;  // names its line already
      section.fail(error.what());
    }
    section.requireAllRead();
  }
  if (scene.world.faces().empty()) throw std::invalid_argument(source + ": no solid in the scene");
  if (scene.waypoints.size() < 2) {
    throw std::invalid_argument(source + ": [path] needs at least two waypoint lines");
  }
  return scene;
}

std::vector<std::string_view> builtInScenes() {
  std::vector<std::string_view> names;
  for (const auto& scene : kBuiltInScenes) names.push_back(scene.name);
  return names;
}

std::string_view builtInSceneText(std::string_view name) {
  for (const auto& scene : kBuiltInScenes) {
    if (scene.name == name) return scene.text;
  }
  throw std::invalid_argument("no built-in scene '" + std::string(name) + "'");
}

Scene loadScene(const std::string& name_or_file) {
  for (const auto& scene : kBuiltInScenes) {
    if (scene.name != name_or_file) continue;
    std::istringstream text{std::string(scene.text)};
    return parseScene(text, name_or_file);
  }
  std::ifstream file(name_or_file);
  if (!file) {
    std::string names;
    for (const auto& scene : kBuiltInScenes) names += " " + std::string(scene.name);
    throw std::runtime_error("cannot read scene file '" + name_or_file +
                             "'; it is no built-in scene either:" + names);
  }
  Scene scene = parseScene(file, name_or_file);
  scene.name = std::filesystem::path(name_or_file).stem().string();
  return scene;
}

}  // namespace opp::mapping
