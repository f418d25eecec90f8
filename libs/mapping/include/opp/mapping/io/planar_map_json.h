// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace opp::mapping {

/// What detection on one cloud adds to the file.
struct DetectionSummary {
  std::vector<std::pair<std::string, double>> timings_ms;  ///< stage and its time [ms]
  std::size_t points = 0;                                  ///< of the cloud
};

/// The map as JSON text in the form of docs/planar_map.schema.json, one element a line. Numbers
/// have the fewest digits that read back as the same double, so parsing gives the same map, and the
/// same map gives the same bytes. \param detection adds "timings_ms" and "points" if given.
/// \throws std::invalid_argument if a number is not finite.
std::string formatPlanarMap(const PlanarMap& map, const DetectionSummary* detection = nullptr);

/// Writes formatPlanarMap to a file, whole or not at all.
/// \throws std::invalid_argument as above, std::runtime_error if the file cannot be written.
void writePlanarMap(const std::filesystem::path& path, const PlanarMap& map,
                    const DetectionSummary* detection = nullptr);

/// Reads a map. Keys that are not of the schema are ignored. \param name what errors call the text.
/// \throws std::runtime_error that names the element and what is wrong with it: syntax, a missing
/// key, a wrong type, a normal or quaternion that is not a unit vector within 1e-6, a duplicate id,
/// a reference to a plane that is not there, a ring of fewer than 3 vertices.
PlanarMap parsePlanarMap(std::string_view text, const std::string& name);

/// As above, from a file. \throws std::runtime_error also if it cannot be read.
PlanarMap readPlanarMap(const std::filesystem::path& path);

}  // namespace opp::mapping
