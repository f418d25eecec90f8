// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "opp/mapping/core/planar_map.h"
#include "opp/mapping/core/trajectory.h"

#include <filesystem>

namespace opp::mapping {

/// Writes the map for MRPT's SceneViewer3D (.3Dscene), whole or not at all. Objects by name:
/// "planes" (seen from the side from which they were scanned only, so that one looks into a room
/// from outside), "outlines", "lines", "corners" (their axes), "trajectory".
/// \throws std::runtime_error if the file cannot be written.
void writeScene(const std::filesystem::path& path, const PlanarMap& map,
                const Trajectory& trajectory);

enum class SceneView { kPerspective, kTop };

/// How renderScene looks at a map.
struct RenderOptions {
  SceneView view = SceneView::kPerspective;
  int width = 1280;        ///< [pixels], 16 to 8192
  int height = 960;        ///< [pixels], 16 to 8192
  double azimuth = -2.2;   ///< [rad] of the eye about the vertical, perspective view only
  double elevation = 0.7;  ///< [rad] of the eye above the horizon, perspective view only
};

/// Draws the map to a PNG file, whole or not at all; no display is needed (EGL). `up`: unit vector
/// in the map's frame. Not byte-identical across graphics drivers.
/// \throws std::invalid_argument for a bad size; std::runtime_error if the file cannot be written
/// or there is no EGL driver.
void renderScene(const std::filesystem::path& path, const PlanarMap& map,
                 const Trajectory& trajectory, const Eigen::Vector3d& up,
                 const RenderOptions& options = {});

}  // namespace opp::mapping
