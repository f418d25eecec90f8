// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/simulation/hand_path.h"
#include "opp/mapping/simulation/world.h"

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace opp::mapping {

/// A world and the way a sensor takes through it.
struct Scene {
  std::string name;
  std::string description;
  World world;
  std::vector<Waypoint> waypoints;
  HandMotion motion;
  int frames = 100;  ///< how many the path is cut into if nobody says otherwise
};

/// Reads a scene in the format of rawlogs/README.md: sections [kind name] (repeatable) of
/// `key = value` lines, # starts a comment, lengths in metres, angles with deg or rad.
/// \param source names the text in messages.
/// \throws std::invalid_argument that names source, line and what is wrong.
Scene parseScene(std::istream& text, const std::string& source);

/// Names of the scenes that come with the library, in alphabetic order.
std::vector<std::string_view> builtInScenes();

/// Text of a built-in scene. \throws std::invalid_argument if there is none of this name.
std::string_view builtInSceneText(std::string_view name);

/// A built-in scene, or the scene in a file where `name_or_file` is not a built-in name.
/// \throws std::runtime_error if the file cannot be read, std::invalid_argument as parseScene.
Scene loadScene(const std::string& name_or_file);

}  // namespace opp::mapping
