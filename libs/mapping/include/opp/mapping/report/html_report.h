// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace opp::mapping {

/// Where the body was at the scans of one session.
struct SessionTrack {
  std::vector<double> times;               ///< of all scans that were read, ascending [s]
  std::vector<Eigen::Vector3d> positions;  ///< in the map; NaN where the scan is not in it
};

/// What the report says of a map that stayed apart.
struct PartFigures {
  std::set<std::size_t> sessions;  ///< that its scans are from, from 0
  std::size_t scans = 0;
  std::size_t keyframes = 0;
  std::size_t planes = 0;
  std::size_t lines = 0;
  std::size_t corners = 0;
};

/// What the report shows that no other file of the run holds in the form it needs.
struct ReportFigures {
  PlanarMap map;
  Eigen::Isometry3d level_from_map = Eigen::Isometry3d::Identity();  ///< see levelFromMap
  std::vector<SessionTrack> tracks;                                  ///< one a session
  std::vector<PartFigures> parts;  ///< those in parts/1, parts/2, ...
};

/// Bytes of those files of a run that the report shows.
struct ReportFiles {
  std::string run_json;
  std::string effective_ini;
  std::string planar_map_glb;
  std::string floorplan_svg;
};

/// A self-contained page of HTML: 3D view, floor plan, what became of the input, trajectory over
/// time, seconds per stage, counts, every warning, parameters. It needs nothing from elsewhere but
/// the links to the folders of parts; without WebGL the floor plan stands for the 3D view. About
/// 1 MB more than its map. \throws std::runtime_error if `files.run_json` is none (what
/// writeRunJson writes).
std::string htmlReport(const ReportFiles& files, const ReportFigures& figures);

/// Writes report.html, whole or not at all, into a folder that holds the other files of the run.
/// \throws std::runtime_error if one of ReportFiles is missing or the page cannot be written.
void writeHtmlReport(const std::filesystem::path& folder, const ReportFigures& figures);

}  // namespace opp::mapping
